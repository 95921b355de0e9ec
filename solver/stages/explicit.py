"""The explicit solution: the motion that lessens an objective under every request (thesis 4.3).

It starts from an implicit one, where every equation holds, and takes Gauss-Newton steps.
"""

from collections.abc import Mapping

from ..arrays import FloatArray
from ..data.requests import ObjectiveKind
from ..data.status import Status
from ..numerics.block_banded import BlockBanded
from ..optimisation.kkt_step import Linearised
from ..optimisation.sqp import Outcome, Progress, Step, restore
from ..transcription.motion import Motion
from ..transcription.objectives import (
    AngleRates,
    ContactForces,
    MassPlaces,
    Power,
    Quantity,
    Squares,
    Term,
    TorqueSmoothness,
    WeightedSum,
    nodes_of,
)
from ..transcription.tracking_cost import TrackingCost
from ..transcription.transcription import Transcription
from .constraint_builder import preferred_poses
from .fit import ADAPT_PRICES, motion_target
from .setup import Setup

MOST_STEPS = 12
DAMPING = 0.02  # of what DRIFT costs; keeps the steps sane without being part of the goal
DRIFT = 0.05  # m, rms; a drift from the start that costs as much as the whole objective there
LEAST = 1e-9
ENOUGH = 0.02  # of the goal: what a further step must gain
SHORTEST = 0.05
MOST_CORRECTIONS = 4
SETTLED = 20.0  # times the tolerances: near enough to compare goals


class Near:
    """TrackingCost to the start as a term. value, expand: see objectives.Term."""

    def __init__(self, closeness: TrackingCost, scale: float) -> None:
        self._closeness, self.scale = closeness, scale

    def value(self, x: FloatArray) -> float:
        return self._closeness.value(x)

    def expand(self, x: FloatArray, gradient: FloatArray, hessian: BlockBanded) -> None:
        slope, metric = self._closeness.expand(x)
        gradient += self.scale * slope
        hessian.lower[: metric.band + 1] += self.scale * metric.lower


def explicit(
    outcome: Outcome,
    plan: Setup,
    objectives: Mapping[ObjectiveKind, float],
    progress: Progress | None,
) -> tuple[list[Outcome], float]:
    """Lessens weighted objectives from a motion that meets every request.

    Returns the steps' outcome and that of the restoring after, and the goal's value in shares of
    that at the start; nothing and 1 where no motion with a lower objective was reached.
    """
    t = outcome.transcription
    goal = weighed(t, outcome.x, plan, objectives)
    near = descend(t, goal, outcome.x, plan, progress)
    settled = restore(
        t,
        goal.damping(near.x),
        near.x,
        plan.goal,
        stage="explicit",
        basis=plan.basis,
        progress=progress,
    )
    if settled.status is not Status.SOLVED or goal.value(settled.x) >= goal.value(outcome.x):
        return [], 1.0
    return [near, settled], goal.value(settled.x) / goal.value(outcome.x)


def descend(
    t: Transcription,
    goal: WeightedSum,
    x: FloatArray,
    plan: Setup,
    progress: Progress | None,
) -> Outcome:
    """Gauss-Newton steps along the valid motions, until one gains little.

    A step is brought back to the valid motions before its goal is judged, for a small violation
    would buy a lot of it (a feasible-direction method with second-order corrections).
    """
    steps: list[Step] = []
    value, working = goal.value(x), None
    violation, length = 0.0, 1.0
    for _ in range(MOST_STEPS):
        rows = t.rows(x, plan.goal)
        gradient, hessian = goal.expand(x)
        line = Linearised(t, rows, hessian, basis=plan.basis, working=working)
        d, _ = line.step(rows.value, gradient)
        working = line.working
        violation = line.worst(rows.value)
        found = _settled_step(t, goal, line, x, d, plan.goal, (value, min(1.0, 2.0 * length)))
        length = found[2] if found else 0.0
        steps.append(Step("explicit", violation, length, line.worst_name(rows.value)))
        if found is None:
            break
        before, (x, value, _) = value, found
        if progress is not None:
            progress(steps[-1], Motion(t, x, plan.goal))
        if before - value < ENOUGH * before:
            break
    return Outcome(x, t, Status.SOLVED, tuple(steps), violation, plan.goal)


def _settled_step(
    t: Transcription,
    goal: WeightedSum,
    line: Linearised,
    x: FloatArray,
    d: FloatArray,
    places: FloatArray,
    begin: tuple[float, float],
) -> tuple[FloatArray, float, float] | None:
    """The longest of d times a length, its half, … that lessens the goal once the rows hold again:
    unknowns, goal and length; None if none does. begin: the goal's value, and the length."""
    value, length = begin
    while length > SHORTEST:
        trial = x + length * d
        rows = t.values(trial, places)
        for _ in range(MOST_CORRECTIONS):
            if line.worst(rows) <= SETTLED:
                break
            trial = trial + line.step(rows)[0]
            rows = t.values(trial, places)
        if line.worst(rows) <= SETTLED:
            reached = goal.value(trial)
            if reached < value:
                return trial, reached, length
        length *= 0.5
    return None


def weighed(
    t: Transcription, x: FloatArray, plan: Setup, objectives: Mapping[ObjectiveKind, float]
) -> WeightedSum:
    """The goal of weighted objectives, each in shares of its value at x (K, n_block), and of poses
    that are only preferred. Without objectives it is closeness to x that these have to outweigh."""
    start = Motion(t, x, plan.goal)
    closeness = TrackingCost(t, motion_target(start), ADAPT_PRICES)
    typical = 0.5 * DRIFT**2 * start.duration
    terms: list[Term] = [*preferred_poses(plan.requests, plan.scene, t)]
    if not objectives:
        terms.append(Near(closeness, 1.0))
    for objective, weight in objectives.items():
        if weight <= 0.0:
            continue
        if objective is ObjectiveKind.CLOSENESS:
            terms.append(Near(closeness, weight / typical))
            continue
        for term in _terms(objective, t, plan):
            term.scale = weight / max(term.value(x), LEAST)
            terms.append(term)
    still = closeness.expand(x)[1]
    still.lower *= DAMPING / typical
    still.add_diagonal((~t.active).astype(float))
    return WeightedSum(terms, lambda _: still)


def _terms(objective: ObjectiveKind, t: Transcription, plan: Setup) -> list[Term]:
    def from_start(quantity: Quantity) -> Term:
        return Squares(t, quantity, nodes_of(plan.start, t, quantity))

    match objective:
        case ObjectiveKind.TORQUE_SMOOTHNESS:
            return [TorqueSmoothness(t, plan.torques)]
        case ObjectiveKind.TORQUE_OUTPUT:
            return [Squares(t, plan.torques)]
        case ObjectiveKind.POWER:
            return [Squares(t, Power(plan.torques))]
        case ObjectiveKind.MASS_DISPLACEMENT:
            return [from_start(MassPlaces())]
        case ObjectiveKind.ANGLE_DISPLACEMENT:
            return [from_start(AngleRates(0))]
        case ObjectiveKind.ANGLE_SMOOTHNESS:
            return [Squares(t, AngleRates(2))]
        case ObjectiveKind.TOTAL_CHANGE:
            return [
                from_start(AngleRates(0)),
                from_start(plan.torques),
                from_start(ContactForces()),
            ]
    raise ValueError(objective)
