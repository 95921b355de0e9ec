"""Torques as functions of the unknowns: against inverse dynamics, and their Jacobians."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.solver.body.inverse_dynamics import InverseDynamics
from hangtime.solver.body.passive_joints import evaluate_passive_torques
from hangtime.solver.data.constants import STANDARD_GRAVITY
from hangtime.solver.data.status import Status
from hangtime.solver.transcription.constraint import Bounds, Constraint, dense_violation
from hangtime.solver.transcription.motion import Motion, motion_inverse_dynamics
from hangtime.solver.transcription.sampling import Instants, State
from hangtime.solver.transcription.torque_constraint import TorqueFunction
from hangtime.solver.transcription.transcription import Transcription
from hangtime.tests.helpers.toy_problems import (
    DURATION,
    figure,
    held_between,
    jacobian_error,
    places,
    random_state,
    seen,
    standing,
    still,
    stood,
)

TIMES = np.linspace(0.0, DURATION, 17)
KNEE = (5,)  # the left knee's angle
ALL = tuple(range(3, 9))


def torque_function(angles: tuple[int, ...]) -> TorqueFunction:
    return TorqueFunction(figure(), standing().points, angles)


def torques(t: Transcription, x: np.ndarray, angles: tuple[int, ...]) -> np.ndarray:
    return torque_function(angles).value(State(t.character, t.layout, Instants(t.basis, TIMES), x))


@pytest.mark.parametrize("angles", [ALL, KNEE, (8, 3)])
def test_they_are_inverse_dynamics_torques(angles: tuple[int, ...]) -> None:
    x = random_state(0)
    motion = Motion(standing(), x, places())
    efforts = motion_inverse_dynamics(InverseDynamics(figure(), standing().points), motion, TIMES)
    weight = figure().mass * STANDARD_GRAVITY
    expected = efforts.torques[:, np.array(angles) - 3] / weight
    found = torques(standing(), x, angles)
    assert np.abs(expected).max() > 0.01
    assert found == pytest.approx(expected, abs=1e-9 * np.abs(expected).max())


@pytest.mark.parametrize("angles", [ALL, KNEE])
def test_jacobians(angles: tuple[int, ...]) -> None:
    for seed in range(3):
        torques_at = torque_function(angles)
        assert jacobian_error(seen(standing(), random_state(seed)), torques_at, 40 + seed) < 1e-6


def test_muscles_give_what_passive_tissue_does_not() -> None:
    state = seen(standing(), random_state(4))
    whole = torque_function(ALL)
    muscles = TorqueFunction(figure(), standing().points, ALL, of_muscles=True)
    passive = evaluate_passive_torques(figure(), state.angles(), state.angles(1))[:, list(ALL)]
    assert np.abs(passive).max() > 1.0
    weight = figure().mass * STANDARD_GRAVITY
    assert muscles.value(state) == pytest.approx(whole.value(state) - passive / weight)
    assert jacobian_error(state, muscles, 44) < 1e-6


def test_jacobians_where_nothing_touches() -> None:
    pose = still(figure(), 0.3 * np.arange(figure().n_angles))
    function = TorqueFunction(figure(), (), ALL)
    assert jacobian_error(pose, function, 50) < 1e-6


def test_gravity_is_the_character_s() -> None:
    """A leg held out is a sixth as heavy on the Moon."""
    moon = replace(figure(), gravity=1.62)
    # The centre of mass falls unless something holds it: here nothing accelerates, and all hangs.
    pose = still(figure(), np.array([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0]))
    here, there = (TorqueFunction(c, (), ALL).value(pose) for c in (figure(), moon))
    assert np.abs(here).max() > 0.01
    assert there == pytest.approx(1.62 / STANDARD_GRAVITY * here)


def test_a_bound_is_kept_between_its_rows_too() -> None:
    bound = 0.5 * float(np.abs(torques(standing(), stood().x, KNEE)).max())
    limits = Bounds(np.array([-bound]), np.array([bound]))
    constraint = Constraint("knee", torque_function(KNEE), limits, 0.0, DURATION)
    t = replace(standing(), constraints=(constraint,))
    before = dense_violation(constraint, figure(), t.basis, t.layout, stood().x)
    assert before.name == "knee"
    assert before.amount > 0.8 * bound
    _, outcome = held_between(t, stood())
    assert outcome.status is Status.SOLVED
    after = dense_violation(constraint, figure(), t.basis, t.layout, outcome.x)
    assert after.amount < 0.1 * bound
