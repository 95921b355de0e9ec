"""Limp joints have a target for their torques: few of their bounds are left to a step's program,
and an objective's minimum stays where it is."""

import numpy as np
import pytest
from hangtime.solver.arrays import BoolArray, FloatArray
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.data.requests import Requests, TorqueLimit
from hangtime.solver.data.row_kinds import RowKind
from hangtime.solver.optimisation import limp_torques
from hangtime.solver.optimisation.kkt_step import KktStep
from hangtime.solver.optimisation.restoration import restore
from hangtime.solver.stages.implicit import adapt
from hangtime.solver.stages.setup import Setup, set_up
from hangtime.tests.helpers.fitted_hop import fitted_hop

LEG = ("RightUpLeg", "RightLeg")


def with_leg(bound: float) -> MotionProblem:
    """A leg whose muscles give bound, N·m, at most."""
    return MotionProblem(requests=Requests(torques=(TorqueLimit("Leg", LEG, bound=bound),)))


@pytest.fixture(scope="module")
def limp() -> Setup:
    return set_up(fitted_hop(), with_leg(0.0))


def a_step(setup: Setup, after: int) -> tuple[KktStep, BoolArray, FloatArray]:
    """A step after some others; flags of the torques' rows, and by how much each is still beyond
    its bounds to first order, over its tolerance."""
    feasible, x = setup.feasible_set(setup.start.transcription), setup.start.x
    x = restore(feasible, setup.metric, x, stage="test", max_steps=after).x
    rows = feasible.rows(x)
    step = feasible.linearise(rows, setup.metric).step(rows.value, limp_to_middle=True)
    left = np.abs(rows.violation(rows.value + step.change)) / rows.tolerance
    return step, rows.kind == RowKind.TORQUE, left


@pytest.mark.slow
def test_few_bounds_of_a_limp_leg_are_left_to_the_program(
    limp: Setup, monkeypatch: pytest.MonkeyPatch
) -> None:
    def at_bounds(price: float) -> float:
        monkeypatch.setattr(limp_torques, "PRICE", price)
        step, torques, left = a_step(limp, after=3)
        assert left[torques].max() < 1.0
        return float((step.multipliers[torques] != 0.0).mean())

    assert at_bounds(limp_torques.PRICE) < 0.6 * at_bounds(0.0)


def test_a_limb_that_is_weak_but_not_limp_has_no_target(monkeypatch: pytest.MonkeyPatch) -> None:
    weak = set_up(fitted_hop(), with_leg(20.0))
    priced = a_step(weak, after=0)[0]
    monkeypatch.setattr(limp_torques, "PRICE", 0.0)
    assert np.array_equal(a_step(weak, after=0)[0].d, priced.d)


def test_an_objectives_minimum_stays_where_it_is(limp: Setup) -> None:
    """Where torques are between their bounds but not in the middle, and nothing is to be gained."""
    feasible = limp.feasible_set(limp.start.transcription)
    rows = feasible.rows(limp.start.x)
    torques = rows.kind == RowKind.TORQUE
    inside = np.clip(rows.value, rows.lower, rows.upper)
    inside[torques] = (0.7 * rows.lower + 0.3 * rows.upper)[torques]
    linearised = feasible.linearise(rows, limp.metric)
    assert not linearised.step(inside).d.any()
    assert linearised.step(inside, limp_to_middle=True).d.any()


@pytest.mark.slow
def test_a_leg_that_is_limp_throughout_a_jump_is_solved() -> None:
    """Its muscles give 0.2 N·m at most at every instant, in a few dozen steps."""
    found = adapt(fitted_hop(), with_leg(0.0))
    assert found.solved
    assert sum(len(outcome.steps) for outcome in found.outcomes) < 40
