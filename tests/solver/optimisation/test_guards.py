"""Guards join ahead of the step that would break them, and are in the way where their rows pull."""

from dataclasses import replace

import numpy as np
from hangtime.solver.arrays import FloatArray
from hangtime.solver.data.problem import MotionProblem, Pin
from hangtime.solver.human.human_guard import RangeLeft, recorded_ranges
from hangtime.solver.optimisation.guards import in_the_way
from hangtime.solver.optimisation.restoration import restore
from hangtime.solver.optimisation.sqp import FeasibleSet, worst_violation
from hangtime.solver.stages.setup import set_up
from hangtime.solver.transcription.guard_rows import GuardRows
from hangtime.tests.helpers.fitted_hop import fitted_hop
from hangtime.tests.helpers.toy_problems import metric, stood


def kept(beyond: dict[str, float]) -> tuple[set[str], tuple[str, ...]]:
    """What is in the way of a valid motion whose joints all keep to ranges that they are in, but
    for those, rad beyond; and the joints' names."""
    motion, ranges = stood(), recorded_ranges(stood())
    names, count = tuple(each.name for each in ranges), len(ranges)
    items, times = np.arange(count), np.full(count, 0.5 * motion.duration)
    function = RangeLeft(ranges, items, np.ones(count, dtype=bool))
    t = motion.transcription
    loose = replace(t, guards=(GuardRows(names, items, times, np.zeros(count), function),))
    left = loose.guard_rows(motion.x).value
    lower = left - 0.1 + np.array([0.1 + beyond[n] if n in beyond else 0.0 for n in names])
    tight = replace(t, guards=(GuardRows(names, items, times, lower, function),))
    return in_the_way(FeasibleSet(tight, motion.places), metric(motion), motion.x), names


def test_nothing_is_in_the_way_of_a_motion_that_keeps_to_all() -> None:
    assert kept({})[0] == set()


def test_the_joint_that_is_beyond_its_range_is_in_the_way() -> None:
    for name in kept({})[1]:
        assert kept({name: 0.2})[0] == {name}


def test_what_a_step_would_break_is_kept_by_that_very_step() -> None:
    """A joint that the way to a landing further off turns the most must turn half as far."""
    problem = MotionProblem(pins=(Pin("landing", "ground 2", offset=(0.2, 0.0, 0.0)),))
    setup = set_up(fitted_hop(), problem)
    start, feasible = setup.start, setup.feasible_set(setup.start.transcription)
    free = restore(feasible, setup.metric, start.x, stage="test", max_steps=1)
    ranges, times = recorded_ranges(start), np.linspace(0.0, start.duration, 20)
    items, at = (grid.ravel() for grid in np.meshgrid(np.arange(len(ranges)), times))

    def guard(lower: FloatArray) -> FeasibleSet:
        names, function = tuple(e.name for e in ranges), RangeLeft(ranges, items, at >= 0.0)
        rows = GuardRows(names, items, at, lower, function)
        return replace(feasible, transcription=replace(start.transcription, guards=(rows,)))

    loose = guard(np.full(len(at), -np.inf))
    before, after = (loose.transcription.guard_rows(x).value for x in (start.x, free.x))
    most = int(np.argmin(after - before))
    lower = np.full(len(at), -np.inf)
    lower[most] = 0.5 * (before + after)[most]
    kept = guard(lower)

    def wider(now: FeasibleSet, x: FloatArray) -> FeasibleSet:
        broken = worst_violation(kept.transcription.guard_rows(x)) > 1.0
        return kept if broken and not now.transcription.guards else now

    found = restore(feasible, setup.metric, start.x, stage="test", max_steps=1, wider=wider)
    off = [worst_violation(kept.transcription.guard_rows(x)) for x in (free.x, found.x)]
    assert len(found.steps) == 1
    assert off[0] > 10.0
    assert off[1] < 0.1 * off[0]
