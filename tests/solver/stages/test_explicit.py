"""The explicit solution: every objective is lessened, nothing asked for is given up for it."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hangtime.solver.data.problem import MotionProblem, Pin
from hangtime.solver.data.requests import Moment, PoseRequest, Requests, When
from hangtime.solver.data.solver_options import (
    Method,
    ObjectiveKind,
    Reduction,
    ReductionKind,
    SolverOptions,
)
from hangtime.solver.objectives.least_squares import (
    AngleDerivatives,
    ContactForces,
    LeastSquares,
    MassPositions,
    ObjectiveTerm,
    Power,
    TorqueSmoothness,
    WeightedObjective,
    torque_metric,
)
from hangtime.solver.optimisation.kkt_step import LinearisedProblem
from hangtime.solver.results.report import change
from hangtime.solver.results.violations import condition_violations
from hangtime.solver.stages.explicit import weighted_objective
from hangtime.solver.stages.implicit import Adaptation, adapt
from hangtime.solver.stages.setup import set_up
from hangtime.solver.transcription.torque_constraint import joint_torques
from hangtime.tests.helpers.fitted_hop import fitted_hop
from hangtime.tests.helpers.toy_problems import random_state, standing, stood

FURTHER = (Pin("Landing", "ground 2", offset=(0.15, 0.0, 0.05)),)
SAME = 1e-3  # m; a step's sweeps end at a thousandth, so two ways to one motion part by less
WEIGHED = [objective for objective in ObjectiveKind if objective is not ObjectiveKind.CLOSENESS]


def asked(requests: Requests) -> MotionProblem:
    return MotionProblem(pins=FURTHER, requests=requests)


@cache
def implicit() -> Adaptation:
    return adapt(fitted_hop(), asked(Requests()))


def terms() -> dict[str, ObjectiveTerm]:
    t = standing()
    torques = joint_torques(t)
    return {
        "torque smoothness": TorqueSmoothness(t, torques),
        "torque output": LeastSquares(t, torques),
        "power": LeastSquares(t, Power(torques)),
        "mass places": LeastSquares(t, MassPositions()),
        "angles": LeastSquares(t, AngleDerivatives(0)),
        "angle smoothness": LeastSquares(t, AngleDerivatives(2)),
        "forces": LeastSquares(t, ContactForces()),
    }


@pytest.mark.parametrize("name", terms())
def test_gradients_agree_with_differences(name: str) -> None:
    t, x = standing(), random_state(3)
    term = terms()[name]
    goal = WeightedObjective([term], lambda _: torque_metric(stood(), joint_torques(t)))
    gradient, _ = goal.expand(x)
    direction = np.random.default_rng(1).normal(size=x.shape) * t.active
    ahead, behind = (term.value(x + step * 1e-6 * direction) for step in (1.0, -1.0))
    assert (gradient * direction).sum() == pytest.approx((ahead - behind) / 2e-6, rel=1e-5)


@pytest.mark.parametrize("name", terms())
def test_hessians_are_the_squares_of_the_residuals_slopes(name: str) -> None:
    """For a quadratic they give the next value; here to first order in a small step."""
    t, x = standing(), random_state(4, 0.05)
    term = terms()[name]
    zero = torque_metric(stood(), joint_torques(t))
    zero.lower[:] = 0.0
    gradient, hessian = WeightedObjective([term], lambda _: zero).expand(x)
    direction = np.random.default_rng(2).normal(size=x.shape) * t.active
    assert (direction * hessian.times(direction)).sum() >= 0.0
    size = 1e-4
    step = size * direction
    expected = (gradient * step).sum() + 0.5 * (step * hessian.times(step)).sum()
    assert term.value(x + step) - term.value(x) == pytest.approx(expected, rel=0.05)


@pytest.mark.slow
@pytest.mark.parametrize("objective", WEIGHED)
def test_every_objective_is_lessened_and_every_request_still_met(objective: ObjectiveKind) -> None:
    start = implicit()
    weights = ((objective, 1.0), (ObjectiveKind.CLOSENESS, 0.3))
    solution = SolverOptions(Method.EXPLICIT, objectives=weights)
    found = adapt(fitted_hop(), asked(Requests(solution=solution)))
    assert found.solved
    t = start.motion.transcription
    goal = weighted_objective(t, start.motion.x, start.setup, {objective: 1.0})
    ends = [o for o in found.outcomes if o.steps and o.steps[0].stage == "explicit"]
    assert ends, "no better motion was found"
    other = weighted_objective(ends[-1].transcription, ends[0].x, found.setup, {objective: 1.0})
    assert other.terms  # of the same kind as the start's
    before = sum(term.value(start.motion.x) for term in goal.terms)
    after = sum(term.value(found.motion.x) for term in other_terms(found, objective))
    assert after < before
    drift = max(found.motion.drift(i, c_times(found, i)).max() for i in range(4))
    assert drift < 1e-3


def other_terms(found: Adaptation, objective: ObjectiveKind) -> list[ObjectiveTerm]:
    motion = found.motion
    return list(
        weighted_objective(motion.transcription, motion.x, found.setup, {objective: 1.0}).terms
    )


def c_times(found: Adaptation, i: int) -> np.ndarray:
    contact = found.motion.transcription.contacts[i]
    return np.linspace(contact.contact.start, contact.contact.end, 50)


@pytest.mark.slow
def test_torques_weighed_in_the_step_change_less() -> None:
    """In the first step, before nonlinearity mixes what the norms want."""
    fit = fitted_hop()
    solution = SolverOptions(Method.IMPLICIT_TORQUES)
    assert adapt(fit, asked(Requests(solution=solution))).solved
    moved = []
    for requests in (Requests(), Requests(solution=solution)):
        setup = set_up(fit, asked(requests))
        t = setup.start.transcription
        linearised = LinearisedProblem(t, t.rows(setup.start.x, setup.target_places), setup.metric)
        step = linearised.step(linearised.rows.value).d
        moved.append(float((step * fit.torque_metric.times(step)).sum()))
    assert moved[1] < moved[0]


@pytest.mark.slow
def test_a_preferred_pose_is_approached_but_not_held() -> None:
    when = When(phase="flight 1", moment=Moment.APEX)
    frame = float(fitted_hop().performance.recording.frames[0])
    held = PoseRequest("Tuck", when, frame=frame)
    soft = replace(held, weight=3.0)
    misses = []
    for poses in ((), (soft,)):
        found = adapt(fitted_hop(), MotionProblem(requests=Requests(poses=poses)))
        assert found.solved
        setup = set_up(fitted_hop(), MotionProblem(requests=Requests(poses=(held,))))
        (constraint,) = setup.start.transcription.constraints
        motion = found.motion
        at = np.array([constraint.start])
        wanted = constraint.function.wanted(at)
        misses.append(np.abs(motion.angles(at)[:, constraint.function.which] - wanted).max())
    assert 0.01 < misses[1] < 0.9 * misses[0]


@pytest.mark.slow
def test_a_reduction_of_full_rank_gives_the_full_problems_result() -> None:
    n = fitted_hop().motion.transcription.character.n_angles
    for kind in (ReductionKind.PCA, ReductionKind.VARIMAX):
        reduction = Reduction(kind, dimensions=n - 3)
        found = adapt(fitted_hop(), asked(Requests(solution=SolverOptions(reduction=reduction))))
        assert found.solved
        times = np.linspace(0.0, found.motion.duration, 100)
        apart = found.motion.joint_centres(times) - implicit().motion.joint_centres(times)
        assert np.abs(apart).max() < SAME


@pytest.mark.slow
@pytest.mark.parametrize("kind", [k for k in ReductionKind if k is not ReductionKind.MATRIX])
def test_every_reduction_solves_and_moves_only_along_itself(kind: ReductionKind) -> None:
    found = adapt(
        fitted_hop(), asked(Requests(solution=SolverOptions(reduction=Reduction(kind, 24))))
    )
    if kind is ReductionKind.MIRROR_LEGS:
        found = adapt(
            fitted_hop(), asked(Requests(solution=SolverOptions(reduction=Reduction(kind))))
        )
    assert found.solved
    assert all(each.amount <= each.kind.tolerance for each in condition_violations(found))
    layout, basis = found.motion.transcription.layout, found.setup.basis
    assert basis is not None
    step = (found.outcomes[0].x - found.setup.start.x)[
        :, layout.angles.start + 3 : layout.angles.stop
    ]
    reduced = basis[layout.angles.start + 3 : layout.angles.stop]
    along, *_ = np.linalg.lstsq(reduced, step.T, rcond=None)
    assert np.abs(reduced @ along - step.T).max() < 1e-9
    assert change(found).joint_centres_rms_cm > 0.5
