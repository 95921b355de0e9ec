"""What cannot be done ends soon, says by name what conflicts, and leaves the best motion found."""

import numpy as np
import pytest
from hangtime.solver.body.anatomy import Part, Side
from hangtime.solver.data.faults import NeedsTorques
from hangtime.solver.data.problem import MotionProblem, Pin
from hangtime.solver.data.requests import ForceRequest, Requests, TorqueLimit, When
from hangtime.solver.data.solver_options import Dynamics, Method, ObjectiveKind, SolverOptions
from hangtime.solver.data.status import Durations
from hangtime.solver.results.violations import condition_violations, most_telling, worst_constraints
from hangtime.solver.stages.implicit import Adaptation, adapt
from hangtime.solver.transcription.motion import dynamics_residual
from hangtime.tests.helpers.fitted_hop import fitted_hop

MOST_STEPS = 200
TAKE_OFF = When(phase="ground 1")


def lower_legs() -> tuple[str, ...]:
    character = fitted_hop().performance.character
    parts = [(p, s) for p in (Part.SHANK, Part.FOOT) for s in (Side.LEFT, Side.RIGHT)]
    return tuple(character.bodies[character.body(p, s)].bone for p, s in parts)


def limp_legs() -> MotionProblem:
    limit = TorqueLimit("Limp legs", lower_legs(), bound=0.0, when=TAKE_OFF)
    return MotionProblem(requests=Requests(torques=(limit,)))


def ice() -> MotionProblem:
    diagonal = Pin("Diagonal", "ground 2", offset=(0.2, 0.5, 0.0))
    return MotionProblem(
        pins=(diagonal,),
        requests=Requests(forces=(ForceRequest("Ice", friction=0.0, when=TAKE_OFF),)),
    )


def far() -> MotionProblem:
    return MotionProblem(pins=(Pin("Far", "ground 2", offset=(7.0, 0.0, 0.0)),))


def check(found: Adaptation, problem: MotionProblem, names: tuple[str, ...]) -> None:
    assert not found.solved
    assert found.stuck is not None
    assert found.reached < 1.0
    assert sum(len(o.steps) for o in found.outcomes) < MOST_STEPS
    worst = worst_constraints(found, problem)
    assert any(part in each.name for each in worst for part in names), worst
    assert np.isfinite(found.motion.x).all()
    if found.reached > 0.0:  # the best motion found obeys physics, it only falls short
        left = dynamics_residual(found.motion, np.linspace(0.01, found.motion.duration - 0.01, 300))
        assert np.sqrt((left.force**2).sum(axis=1).mean()) < 0.02


@pytest.mark.slow
def test_a_landing_seven_metres_away() -> None:
    found = adapt(fitted_hop(), far())
    check(found, far(), ("Far",))
    # Whatever else gives way there, the few that the artist reads name the landing.
    assert any(each.name.startswith("Far: ") for each in most_telling(found, far()))


@pytest.mark.slow
def test_no_grip_on_a_diagonal_take_off() -> None:
    found = adapt(fitted_hop(), ice())
    check(found, ice(), ("toe 1", "heel 1", "ground 1", "Diagonal"))
    assert found.setup.durations in (Durations.NONE_FOUND, Durations.NOT_MET)  # and it is told


@pytest.mark.slow
def test_a_take_off_on_limp_knees_and_ankles() -> None:
    """Arms and a start that is already moving do it; what curves leave of the limit is named."""
    found = adapt(fitted_hop(), limp_legs())
    assert found.solved
    missed = condition_violations(found)
    assert "Limp legs" in {each.name for each in missed}
    assert all(each.amount <= 3.0 * each.kind.tolerance for each in missed), missed
    assert sum(len(o.steps) for o in found.outcomes) < MOST_STEPS


def test_reduced_dynamics_have_no_torques_to_limit() -> None:
    limit = TorqueLimit("Weak knee", lower_legs()[:1], bound=50.0)
    solution = SolverOptions(dynamics=Dynamics.REDUCED)
    with pytest.raises(NeedsTorques) as caught:
        adapt(fitted_hop(), MotionProblem(requests=Requests(torques=(limit,), solution=solution)))
    assert caught.value.request == "Weak knee"


@pytest.mark.parametrize("method", [Method.IMPLICIT_TORQUES, Method.EXPLICIT])
def test_reduced_dynamics_have_no_torques_to_weigh(method: Method) -> None:
    solution = SolverOptions(method, Dynamics.REDUCED)
    with pytest.raises(NeedsTorques):
        adapt(fitted_hop(), MotionProblem(requests=Requests(solution=solution)))


@pytest.mark.slow
def test_what_needs_no_torques_is_lessened_with_reduced_dynamics() -> None:
    weights = ((ObjectiveKind.ANGLE_SMOOTHNESS, 1.0), (ObjectiveKind.CLOSENESS, 1.0))
    solution = SolverOptions(Method.EXPLICIT, Dynamics.REDUCED, weights)
    found = adapt(fitted_hop(), MotionProblem(requests=Requests(solution=solution)))
    assert found.solved
    assert found.gain is not None
    assert found.gain < 1.0
