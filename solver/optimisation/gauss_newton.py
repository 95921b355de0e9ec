"""Gauss-Newton descent in the feasible set: an objective is lowered while every row holds."""

import numpy as np

from ..arrays import FloatArray
from ..data.status import Status
from ..numerics.block_banded import BlockBanded
from .kkt_step import LinearisedProblem, Remains
from .sqp import FeasibleSet, Objective, Outcome, Progress, Step

MAX_STEPS = 12
MIN_DECREASE = 0.02  # of the objective: what a further step must gain
MIN_STEP_LENGTH = 0.05
MAX_CORRECTIONS = 4  # second-order, a trial point
CORRECTION_TOLERANCE = 5.0  # times the tolerances: near enough to compare objectives


def minimise(
    feasible: FeasibleSet,
    objective: Objective,
    x: FloatArray,
    *,
    stage: str,
    max_steps: int = MAX_STEPS,
    progress: Progress | None = None,
) -> Outcome:
    """Gauss-Newton steps in the feasible set from x (K, n_block), until one gains little.

    A trial point is brought back to the set before its objective is judged, for a small violation
    would buy a lot of it: second-order corrections (Nocedal & Wright, 18.3).
    """
    steps: list[Step] = []
    value = objective.value(x)
    last: Remains | None = None
    hessian: BlockBanded | None = None
    violation, length = 0.0, 1.0
    for _ in range(max_steps):
        rows = feasible.rows(x)
        gradient, hessian = objective.expand(x, hessian)
        linearised = feasible.linearise(rows, hessian, last)
        d = linearised.step(rows.value, gradient).d
        last = linearised.remains
        violation = linearised.violation(rows.value)
        begin = (value, min(1.0, 2.0 * max(length, MIN_STEP_LENGTH)))
        found = _corrected_step(feasible, objective, linearised, x, d, begin)
        length = found[2] if found else 0.0
        steps.append(Step(stage, violation, length, linearised.worst_owner(rows.value)))
        del linearised  # as large as all else together: not two at a time
        if found is None:
            break
        before, (x, value, _) = value, found
        if progress is not None:
            progress(steps[-1], feasible.motion(x))
        if before - value < MIN_DECREASE * before:
            break
    return feasible.outcome(x, Status.SOLVED, steps, violation)


def _corrected_step(
    feasible: FeasibleSet,
    objective: Objective,
    linearised: LinearisedProblem,
    x: FloatArray,
    d: FloatArray,
    begin: tuple[float, float],
) -> tuple[FloatArray, float, float] | None:
    """Line search with second-order corrections: unknowns, objective and length.

    Of a length that can be brought back, its half, and where the parabola through both and the
    start is lowest, the best. Lengths that are only halved tie, and recordings that differ by
    rounding would end millimetres apart. None where no length lowers the objective. begin: the
    objective at x, and the first length.
    """
    value, length = begin

    def reached(length: float) -> tuple[FloatArray, float, float] | None:
        trial = _corrected(feasible, linearised, x + length * d)
        return None if trial is None else (trial, objective.value(trial), length)

    while length > MIN_STEP_LENGTH:
        whole, half = reached(length), None
        if whole is not None:
            half = reached(0.5 * length)
        if whole is not None and half is not None:
            low = _lowest(value, half[1], whole[1])
            known = low in (0.0, 0.5, 1.0)
            tried = (whole, half) if known else (whole, half, reached(low * length))
            found = [each for each in tried if each and each[1] < value]
            if found:
                return min(found, key=lambda each: each[1])
        length *= 0.5
    return None


def _lowest(start: float, half: float, whole: float) -> float:
    """Where in [0, 1] the parabola through values at 0, 1/2 and 1 is lowest."""
    slope, bend = 4.0 * half - 3.0 * start - whole, 4.0 * (start - 2.0 * half + whole)
    if bend <= 0.0:
        return float(whole < start)
    return float(np.clip(-slope / bend, 0.0, 1.0))


def _corrected(
    feasible: FeasibleSet, linearised: LinearisedProblem, x: FloatArray
) -> FloatArray | None:
    """Second-order corrections of x (K, n_block); None where they do not converge."""
    before = np.inf
    for _ in range(1 + MAX_CORRECTIONS):
        values = feasible.values(x)
        violation = linearised.violation(values)
        if violation <= CORRECTION_TOLERANCE:
            return x
        if not violation < before:  # diverges, or is not a number any more
            return None
        before = violation
        x = x + linearised.step(values).d
    return None
