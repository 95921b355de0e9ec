"""Steps in parts of a motion: they do what one of the whole does, and change nothing elsewhere."""

from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from hangtime.solver.analysis.analyse import analyse
from hangtime.solver.arrays import FloatArray
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.fitting.fit import Fit, fit
from hangtime.solver.numerics.splines import ORDER
from hangtime.solver.optimisation.local_steps import local_step, parts_around
from hangtime.solver.optimisation.restoration import restore
from hangtime.solver.optimisation.sqp import FeasibleSet
from hangtime.tests.helpers.clips import load_recording

AT = 2.0  # s, where the fit is disturbed


@cache
def walk() -> Fit:
    """Four seconds, with a hop."""
    analysis = analyse(load_recording("131_03_hop.bvh"), MotionProblem())
    return fit(analysis.performance, analysis.schedule)


def disturbed() -> tuple[FeasibleSet, FloatArray, int]:
    """Its motion with one block off by hundredths, the set that it was in, and the span."""
    motion = walk().motion
    t, x = motion.transcription, motion.x.copy()
    span = int(t.basis.spans(np.array([AT]))[0])
    block = t.basis.first_coefficient[span] + 1
    x[block] += 0.02 * t.active[block] * np.random.default_rng(1).normal(size=x.shape[1])
    return FeasibleSet(t, motion.places), x, span


def test_rows_of_some_spans_are_those_rows_of_all() -> None:
    feasible, x, _ = disturbed()
    part = slice(20, 47)
    rows, t = feasible.rows(x), feasible.transcription.within(part)
    some, kept = t.rows(x, feasible.places), (rows.span >= part.start) & (rows.span < part.stop)
    assert some.kind.tolist() == rows.kind[kept].tolist()
    assert np.array_equal(some.owner, rows.owner[kept])
    assert some.value == pytest.approx(rows.value[kept], abs=1e-9)
    assert t.values(x, feasible.places) == pytest.approx(some.value, abs=1e-9)
    inner = (some.span >= part.start + ORDER) & (some.span < part.stop - ORDER)
    assert some.jacobian[inner] == pytest.approx(rows.jacobian[kept][inner], abs=1e-9)


def test_a_step_in_a_part_is_hardly_longer_than_that_of_the_whole() -> None:
    feasible, x, span = disturbed()
    metric, rows = walk().metric, feasible.rows(x)
    whole = feasible.linearise(rows, metric).step(rows.value, limp_to_middle=True).d
    basis = feasible.transcription.basis
    [part] = parts_around(np.array([span]), basis.breaks)
    d = local_step(feasible.transcription, feasible.places, metric, x, part, None)
    assert np.vdot(d, metric.times(d)) < 1.05 * np.vdot(whole, metric.times(whole))
    assert not d[: basis.first_coefficient[part.start - 1] + ORDER].any()
    assert not d[basis.first_coefficient[part.stop] :].any()


def test_restoration_ends_with_steps_in_parts() -> None:
    """Its first step is of the whole; what is far from a violation then stays to the bit."""
    feasible, x, _ = disturbed()
    way = [x]
    restored = restore(
        feasible, walk().metric, x, stage="test", progress=lambda _, motion: way.append(motion.x)
    )
    assert restored.solved
    assert feasible.violation(restored.x) <= 1.0
    changed = [(after != before).any(axis=1) for before, after in pairwise(way)]
    assert changed[0].all()
    assert 0 < changed[-1].sum() < 0.5 * len(x)


def test_parts_join_where_they_meet_and_are_none_where_they_are_most() -> None:
    breaks = np.arange(101) * 0.1  # spans of 0.1 s
    assert parts_around(np.array([2, 50]), breaks) == [slice(0, 8), slice(45, 56)]
    assert parts_around(np.array([30, 38]), breaks) == [slice(25, 44)]
    assert parts_around(np.array([5, 20, 40, 60, 80]), breaks) == []
