"""Steps towards a motion that satisfies every equation and bound (thesis 4.2 and 4.4).

Each step solves the linearised problem

    min  g . d + 1/2 d . W d   subject to   C(x) + C_x d = 0,   lo <= B(x) + B_x d <= hi

with W the metric of closeness.py. With g the gradient of the distance to a target this *projects*
the target onto the valid motions (the fit); with g = 0 it is the thesis's minimum-norm step (the
implicit solution), which converges quadratically and stays near where it began.

The linearised problem itself is solved in linearised.py.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ..arrays import FloatArray
from ..data.status import Status
from ..numerics.block_banded import BlockBanded
from ..transcription.motion import Motion
from ..transcription.rows import Rows
from ..transcription.transcription import Transcription
from .kkt_step import Linearised

CHORD_GAIN = 0.03
SHORTEST_STEP = 0.005
PATIENCE = 6  # steps
NEAR = 1e3  # times the tolerances: the end of a solve
ENOUGH = 0.05  # of the objective: what a further step must gain


@dataclass(frozen=True)
class Step:
    """One step: worst violation over its tolerance before the step, whose, and the length taken.

    worst: a contact's name, a condition's, or the equation's where it is nobody's.
    """

    stage: str
    violation: float
    length: float
    worst: str = ""


@dataclass(frozen=True)
class Outcome:
    """Where the steps ended: unknowns, equations, how and why, and the contacts' places."""

    x: FloatArray
    transcription: Transcription
    status: Status
    steps: tuple[Step, ...]
    violation: float
    places: FloatArray

    @property
    def solved(self) -> bool:
        return self.status is Status.SOLVED


Progress = Callable[[Step, Motion], None]
"""Told each step and where it led; what it raises ends the solve."""


class Stopped(Exception):
    """The solve shall end, with the motion as it stands."""

    def __init__(self, motion: Motion) -> None:
        super().__init__()
        self.motion = motion


class Objective(Protocol):
    """What steps lessen."""

    def value(self, x: FloatArray) -> float:
        """The objective at unknowns (K, n_block)."""

    def expand(self, x: FloatArray) -> tuple[FloatArray, BlockBanded]:
        """Its gradient (K, n_block) and a positive definite approximation of its Hessian."""


def restore(
    transcription: Transcription,
    metric: BlockBanded,
    x: FloatArray,
    places: FloatArray,
    *,
    stage: str,
    most_steps: int = 30,
    basis: FloatArray | None = None,
    progress: Progress | None = None,
) -> Outcome:
    """Minimum-norm steps until equations and bounds hold.

    metric: W, fixed. places: (n_contacts, 3) m. basis: (n_block, k), the changes of a block that
    are allowed (thesis 5), None all. A line search on the summed squared violation guards the
    steps (thesis eq. 4.6). While steps gain an order of magnitude, the next one uses the same
    Jacobian and factor, which costs a third of a new one (chord steps).
    """
    steps: list[Step] = []
    status = Status.TOO_MANY_STEPS
    begun = transcription.rows(x, places)
    here: Rows | None = begun  # the rows at x with their Jacobian, where that is known
    line: Linearised | None = None
    value, last, violation = begun.value, np.inf, worst_violation(begun)
    slow = stale = False
    while len(steps) < most_steps:
        violation = violation if line is None else line.worst(value)
        if violation <= 1.0:
            status = Status.SOLVED
            break
        slow = line is None or violation > CHORD_GAIN * last
        fresh, stale = slow or stale or here is not None, False
        if fresh:
            here = transcription.rows(x, places) if here is None else here
            working = None if line is None else line.working
            line = Linearised(transcription, here, metric, basis=basis, working=working)
        assert line is not None
        whose = line.worst_name(value)
        d, _ = line.step(value)
        at = _shorten(transcription, line, x, d, places, value, whole=slow)
        if at.length < 1.0 and not fresh:  # the old Jacobian no longer serves
            x, value, here, stale = at.x, at.value, None, True
            continue
        x, value, here, length = at.x, at.value, at.rows, at.length
        steps.append(Step(stage, violation, length, whose))
        last = violation
        if progress is not None:
            progress(steps[-1], Motion(transcription, x, places))
        if length == 0.0 or _stagnant(steps):
            status = Status.STALLED
            break
    violation = violation if line is None else line.worst(value)
    return Outcome(x, transcription, status, tuple(steps), violation, places)


def _stagnant(steps: list[Step]) -> bool:
    """Whether the last steps did not even halve the violation."""
    if len(steps) < 2 * PATIENCE:
        return False
    return steps[-1].violation > 0.5 * steps[-1 - PATIENCE].violation


def project(
    transcription: Transcription,
    goal: Objective,
    x: FloatArray,
    places: FloatArray,
    *,
    stage: str,
    most_steps: int,
    basis: FloatArray | None = None,
    progress: Progress | None = None,
) -> Outcome:
    """Steps that lessen a goal among the valid motions; `restore` finishes what they leave.

    Ends when a step changes the goal little; equations and bounds then nearly hold.
    """
    steps: list[Step] = []
    status = Status.TOO_MANY_STEPS
    multipliers: FloatArray | None = None
    objective = goal.value(x)
    line: Linearised | None = None
    for _ in range(most_steps):
        rows = transcription.rows(x, places)
        gradient, metric = goal.expand(x)
        working = None if line is None else line.working
        line = Linearised(transcription, rows, metric, basis=basis, working=working)
        d, multipliers = line.step(rows.value, gradient, multipliers)
        x, length = _search(transcription, goal, x, d, places, line, multipliers, objective)
        worst = (line.worst(rows.value), length, line.worst_name(rows.value))
        steps.append(Step(stage, *worst))
        if progress is not None:
            progress(steps[-1], Motion(transcription, x, places))
        before, objective = objective, goal.value(x)
        if length == 0.0 or (len(steps) > 1 and abs(before - objective) < ENOUGH * before):
            status = Status.SOLVED
            break
    violation = worst_violation(transcription.rows(x, places))
    return Outcome(x, transcription, status, tuple(steps), violation, places)


def worst_violation(rows: Rows) -> float:
    """The worst violation over its kind's tolerance; at most 1 means that all rows hold."""
    return float((np.abs(rows.violation()) / rows.tolerance).max())


@dataclass(frozen=True)
class _Trial:
    """Where a step led: unknowns, the rows' values, its length, and the rows if they are known."""

    x: FloatArray
    value: FloatArray
    length: float
    rows: Rows | None


def _shorten(
    transcription: Transcription,
    line: Linearised,
    x: FloatArray,
    d: FloatArray,
    places: FloatArray,
    value: FloatArray,
    *,
    whole: bool,
) -> _Trial:
    """The longest of d, d/2, d/4 … that lessens the summed squared violation; 0 if none does.

    Near the end, where what is left of different rows has different units, lessening the worst
    violation counts as well. whole: whether the next step will want the Jacobian there, so that
    the full step is tried with it.
    """
    before, worst = line.merit(value), line.worst(value)
    length = 1.0
    while length > SHORTEST_STEP:
        trial = x + length * d
        rows = transcription.rows(trial, places) if whole and length == 1.0 else None
        left = transcription.values(trial, places) if rows is None else rows.value
        enough = 1.0 - 0.1 * length
        near = worst < NEAR and line.worst(left) < enough * worst
        if near or line.merit(left) < enough * before:
            return _Trial(trial, left, length, rows)
        length *= 0.5
    return _Trial(x, value, 0.0, None)


def _search(
    transcription: Transcription,
    goal: Objective,
    x: FloatArray,
    d: FloatArray,
    places: FloatArray,
    line: Linearised,
    multipliers: FloatArray,
    objective: float,
) -> tuple[FloatArray, float]:
    """Backtracks on the goal plus weighted violation (an exact l1 merit function)."""
    weight = 2.0 * float(np.abs(multipliers).max()) + 1e-9
    before = objective + weight * line.total(line.rows.value)
    length = 1.0
    while length > 0.1:
        trial = x + length * d
        violation = line.total(transcription.values(trial, places))
        if goal.value(trial) + weight * violation < before:
            return trial, length
        length *= 0.5
    return x, 0.0
