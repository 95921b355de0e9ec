"""The explicit solution: minimises an objective subject to every request (thesis 4.3).

It starts from an implicit one, where every row holds, and takes Gauss-Newton steps.
"""

from collections.abc import Mapping

from ..arrays import FloatArray
from ..constraints.constraint_builder import preferred_poses
from ..data.solver_options import ObjectiveKind
from ..fitting.fit import ADAPT_COST_WEIGHTS
from ..numerics.block_banded import BlockBanded
from ..objectives.least_squares import (
    AngleDerivatives,
    ContactForces,
    LeastSquares,
    MassPositions,
    ObjectiveTerm,
    Power,
    TorqueSmoothness,
    WeightedObjective,
    values_at_nodes,
)
from ..objectives.motion_metric import motion_target
from ..objectives.tracking_cost import TrackingCost
from ..optimisation.gauss_newton import minimise
from ..optimisation.restoration import restore
from ..optimisation.sqp import Outcome, Progress
from ..transcription.motion import Motion
from ..transcription.sampling import MotionFunction
from ..transcription.transcription import Transcription
from .setup import Setup

DAMPING_SHARE = 0.02  # of what REFERENCE_DRIFT costs: Levenberg damping of the steps
REFERENCE_DRIFT = 0.05  # m, rms; its tracking cost weighs like the whole objective at the start
MIN_OBJECTIVE = 1e-9  # by which terms are divided at least


class TrackingTerm:
    """Tracking cost to the start as an objective's term; see objectives.ObjectiveTerm."""

    def __init__(self, cost: TrackingCost, scale: float) -> None:
        self._cost, self.scale = cost, scale

    def value(self, x: FloatArray) -> float:
        return self._cost.value(x)

    def expand(self, x: FloatArray, gradient: FloatArray, hessian: BlockBanded) -> None:
        mine, metric = self._cost.expand(x)
        gradient += self.scale * mine
        hessian.lower[: metric.band + 1] += self.scale * metric.lower


def explicit(
    outcome: Outcome,
    setup: Setup,
    objectives: Mapping[ObjectiveKind, float],
    progress: Progress | None,
) -> tuple[list[Outcome], float]:
    """Minimises weighted objectives from a motion that meets every request (thesis 4.3).

    Returns the outcomes of minimisation and restoration, and the objective in shares of that at
    the start; nothing and 1 where no motion with a lower objective was reached.
    """
    feasible = setup.feasible_set(outcome.transcription)
    objective = weighted_objective(outcome.transcription, outcome.x, setup, objectives)
    near = minimise(feasible, objective, outcome.x, stage="explicit", progress=progress)
    damping = objective.damping(near.x)
    restored = restore(feasible, damping, near.x, stage="explicit", progress=progress)
    before = objective.value(outcome.x)
    if not restored.solved or (after := objective.value(restored.x)) >= before:
        return [], 1.0
    return [near, restored], after / before


def weighted_objective(
    t: Transcription, x: FloatArray, setup: Setup, objectives: Mapping[ObjectiveKind, float]
) -> WeightedObjective:
    """Weighted objectives, each in shares of its value at x (K, n_block), and preferred poses.

    Without objectives it is the tracking cost to x that the poses have to outweigh.
    """
    start = Motion(t, x, setup.target_places)
    tracking = TrackingCost(t, motion_target(start), ADAPT_COST_WEIGHTS, setup.price)
    typical = 0.5 * REFERENCE_DRIFT**2 * start.duration
    terms: list[ObjectiveTerm] = [*preferred_poses(setup.requests, setup.context, t)]
    if not objectives:
        terms.append(TrackingTerm(tracking, 1.0))
    for kind, weight in objectives.items():
        if weight <= 0.0:
            continue
        if kind is ObjectiveKind.CLOSENESS:
            terms.append(TrackingTerm(tracking, weight / typical))
            continue
        for term in _objective_terms(kind, t, setup):
            term.scale = weight / max(term.value(x), MIN_OBJECTIVE)
            terms.append(term)
    damping = tracking.expand(x)[1]
    damping.lower *= DAMPING_SHARE / typical
    damping.add_diagonal((~t.active).astype(float))
    return WeightedObjective(terms, lambda _: damping)


def _objective_terms(kind: ObjectiveKind, t: Transcription, setup: Setup) -> list[ObjectiveTerm]:
    def from_start(function: MotionFunction) -> ObjectiveTerm:
        return LeastSquares(t, function, values_at_nodes(setup.start, t, function))

    match kind:
        case ObjectiveKind.TORQUE_SMOOTHNESS:
            return [TorqueSmoothness(t, setup.torques)]
        case ObjectiveKind.TORQUE_OUTPUT:
            return [LeastSquares(t, setup.torques)]
        case ObjectiveKind.POWER:
            return [LeastSquares(t, Power(setup.torques))]
        case ObjectiveKind.MASS_DISPLACEMENT:
            return [from_start(MassPositions())]
        case ObjectiveKind.ANGLE_DISPLACEMENT:
            return [from_start(AngleDerivatives(0))]
        case ObjectiveKind.ANGLE_SMOOTHNESS:
            return [LeastSquares(t, AngleDerivatives(2))]
        case ObjectiveKind.TOTAL_CHANGE:
            return [
                from_start(AngleDerivatives(0)),
                from_start(setup.torques),
                from_start(ContactForces()),
            ]
    raise ValueError(kind)
