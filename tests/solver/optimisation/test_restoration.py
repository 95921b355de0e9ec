"""Restoration: it says rightly whether it arrived, and goes no further than it may."""

from itertools import pairwise

import numpy as np
import pytest
from hangtime.solver.arrays import FloatArray
from hangtime.solver.data.problem import MotionProblem, Pin
from hangtime.solver.data.status import Status
from hangtime.solver.optimisation.restoration import restore
from hangtime.solver.optimisation.sqp import NEARLY_FEASIBLE
from hangtime.solver.stages.setup import set_up
from hangtime.tests.helpers.fitted_hop import fitted_hop

FURTHER = MotionProblem(pins=(Pin("landing", "ground 2", offset=(0.2, 0.0, 0.0)),))
AWAY = MotionProblem(pins=(Pin("landing", "ground 2", offset=(0.0, 2.0, 1.0)),)).keeping_times()


def test_the_last_step_that_is_allowed_may_be_the_one_that_arrives() -> None:
    """As many steps as a solve needs are enough for it."""
    setup = set_up(fitted_hop(), FURTHER)
    feasible = setup.feasible_set(setup.start.transcription)
    free = restore(feasible, setup.metric, setup.start.x, stage="test")
    assert free.solved
    enough = len(free.steps)
    again = restore(feasible, setup.metric, setup.start.x, stage="test", max_steps=enough)
    assert again.solved
    less = restore(feasible, setup.metric, setup.start.x, stage="test", max_steps=enough - 1)
    assert less.status is Status.TOO_MANY_STEPS


def test_no_step_turns_a_joint_further_than_it_may() -> None:
    """Knees must bend and legs must swing for a landing that is metres away, by several steps."""
    setup = set_up(fitted_hop(), AWAY)
    feasible = setup.feasible_set(setup.start.transcription)
    angles = feasible.transcription.layout.angles
    ways = [setup.start.x]
    restore(
        feasible,
        setup.metric,
        setup.start.x,
        stage="test",
        max_steps=3,
        max_turn=0.3,
        progress=lambda _, motion: ways.append(motion.x),
    )
    turns = [float(np.abs(b - a)[:, angles].max()) for a, b in pairwise(ways)]
    assert max(turns) == pytest.approx(0.3)


@pytest.mark.slow
def test_a_step_that_raises_the_violation_is_taken_back_where_none_may_follow() -> None:
    """Near the end one may, if the next makes up for it: far from any motion some do."""
    setup = set_up(fitted_hop(), MotionProblem())
    feasible = setup.feasible_set(setup.start.transcription)
    angles = feasible.transcription.layout.angles

    def restored(seed: int) -> tuple[FloatArray, list[float], list[FloatArray], list[int]]:
        """From some start: it, violations, unknowns after each step, and steps that raised it."""
        x = setup.start.x.copy()
        x[:, angles] += 0.1 * np.random.default_rng(seed).normal(size=x[:, angles].shape)
        told: list[FloatArray] = []
        whole = restore(
            feasible, setup.metric, x, stage="test", progress=lambda _, found: told.append(found.x)
        )
        off = [step.violation for step in whole.steps]
        raised = [i for i, (a, b) in enumerate(pairwise(off)) if b > a and a < NEARLY_FEASIBLE]
        # Others lower what is left of all rows, though not of the worst.
        watched = [i for i in raised if feasible.violation(told[i]) == pytest.approx(off[i])]
        return x, off, told, watched

    # From most starts none is.
    x, off, told, watched = next(found for found in map(restored, range(8)) if found[-1])
    for i in watched:
        found = restore(feasible, setup.metric, x, stage="test", max_steps=i + 1)
        assert found.violation == pytest.approx(off[i])
        assert feasible.violation(found.x) == pytest.approx(off[i])
        assert np.array_equal(told[i], found.x)  # where a solve that is stopped then ends
