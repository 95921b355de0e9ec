"""Projection onto the feasible set: SQP steps towards an objective's minimum (thesis 4.2)."""

from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from ..data.status import Status
from ..numerics.block_banded import BlockBanded
from .kkt_step import LinearisedProblem, Remains
from .sqp import NEARLY_FEASIBLE, FeasibleSet, Objective, Outcome, Progress, Step

MIN_PROJECTION_LENGTH = 0.1
MIN_PROJECTION_DECREASE = 0.05  # of the objective: what a further step must gain


def project(
    feasible: FeasibleSet,
    objective: Objective,
    x: FloatArray,
    *,
    stage: str,
    max_steps: int,
    progress: Progress | None = None,
) -> tuple[Outcome, BlockBanded, Remains]:
    """Projection: SQP steps that minimise an objective in the feasible set (thesis 4.2).

    x: (K, n_block). max_steps: at least 1. Ends when a step changes the objective little and the
    rows nearly hold; `restore` finishes what is left. The Hessian of its last step, too, and what
    that leaves to the next.
    """
    steps: list[Step] = []
    status = Status.TOO_MANY_STEPS
    multipliers: FloatArray | None = None
    value, violation = objective.value(x), np.inf
    last: Remains | None = None
    hessian: BlockBanded | None = None
    for _ in range(max_steps):
        rows = feasible.rows(x)
        gradient, hessian = objective.expand(x, hessian)
        linearised = feasible.linearise(rows, hessian, last)
        step = linearised.step(rows.value, gradient, multipliers)
        multipliers = step.multipliers
        merit = _L1Merit.of(feasible, objective, linearised, multipliers)
        start = _Trial(x, value, rows.value)
        trial, length = _backtrack(merit, start, step.d)
        x = trial.x
        worst = linearised.worst_owner(rows.value)
        steps.append(Step(stage, linearised.violation(rows.value), length, worst))
        if progress is not None:
            progress(steps[-1], feasible.motion(x))
        before, value = value, trial.objective
        little = abs(before - value) < MIN_PROJECTION_DECREASE * before
        violation = linearised.violation(trial.rows)
        near = violation < NEARLY_FEASIBLE
        last = linearised.remains
        del linearised, merit  # as large as all else together: not two at a time
        if length == 0.0 or (near and little):
            status = Status.SOLVED
            break
    assert hessian is not None
    assert last is not None
    return feasible.outcome(x, status, steps, violation), hessian, last


@dataclass(frozen=True)
class _Trial:
    """Unknowns (K, n_block), the objective there, and the rows' values (R,)."""

    x: FloatArray
    objective: float
    rows: FloatArray


@dataclass(frozen=True)
class _L1Merit:
    """Exact l1 merit function: objective + penalty * violation (Nocedal & Wright, 15.4)."""

    feasible: FeasibleSet
    objective: Objective
    linearised: LinearisedProblem
    penalty: float

    @staticmethod
    def of(
        feasible: FeasibleSet,
        objective: Objective,
        linearised: LinearisedProblem,
        multipliers: FloatArray,
    ) -> "_L1Merit":
        """With a penalty beyond the largest multiplier, so that the function is exact."""
        penalty = 2.0 * float(np.abs(multipliers).max()) + 1e-9
        return _L1Merit(feasible, objective, linearised, penalty)

    def at(self, x: FloatArray) -> _Trial:
        """The trial point x (K, n_block)."""
        return _Trial(x, self.objective.value(x), self.feasible.values(x))

    def corrected(self, trial: _Trial) -> _Trial:
        """After the shortest step from a trial point to the rows as they were linearised."""
        return self.at(trial.x + self.linearised.step(trial.rows).d)

    def __call__(self, trial: _Trial) -> float:
        return trial.objective + self.penalty * self.linearised.l1_violation(trial.rows)


def _backtrack(merit: _L1Merit, start: _Trial, d: FloatArray) -> tuple[_Trial, float]:
    """Backtracking line search along d (K, n_block); the start itself and 0 if nothing lowers it.

    A trial point that fails gets a second-order correction (Nocedal & Wright, 18.3): rows curve,
    and without it good steps are refused (the Maratos effect).
    """
    length, before = 1.0, merit(start)
    while length > MIN_PROJECTION_LENGTH:
        trial = merit.at(start.x + length * d)
        if merit(trial) < before:
            return trial, length
        corrected = merit.corrected(trial)
        if merit(corrected) < before:
            return corrected, length
        length *= 0.5
    return start, 0.0
