"""Restoration: it says rightly whether it arrived."""

from hangtime.solver.data.problem import MotionProblem, Pin
from hangtime.solver.data.status import Status
from hangtime.solver.optimisation.sqp import restore
from hangtime.solver.stages.setup import set_up
from hangtime.tests.helpers.fitted_hop import fitted_hop

FURTHER = MotionProblem(pins=(Pin("landing", "ground 2", offset=(0.2, 0.0, 0.0)),))


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
