"""Steps towards a motion that satisfies every equation and bound (thesis 4.2 and 4.4).

Each step solves the linearised problem

    min  g . d + 1/2 d . W d   subject to   C(x) + C_x d = 0,   lo <= B(x) + B_x d <= hi

with W the metric of closeness.py. With g the gradient of the distance to a target this *projects*
the target onto the valid motions (the fit); with g = 0 it is the thesis's minimum-norm step (the
implicit solution), which converges quadratically and stays near where it began.

The equations are settled by an augmented Lagrangian on one banded factor, which also settles
redundant rows (two feet planted, pins on one rigid foot) without choosing among them; the bounds
by a small quadratic program (qp.py).
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from .linear import BlockBanded, Factor
from .qp import BoundedStep
from .recording import BoolArray, FloatArray, IntArray
from .rows import RowKind, Rows, by_kind
from .splines import ORDER
from .status import Status
from .threads import in_threads
from .transcription import Transcription

# Speeds are weighed against places by the time in which they would move as far.
NORM = {RowKind.PIN_SPEED: 30.0}
PENALTY = 1e4
AT_ONCE = 32  # spans
FEWEST_EACH = 8  # spans worth a thread of their own
MOST_SWEEPS = 8
SWEEP_GAIN = 1e-3
CHORD_GAIN = 0.03
RIDGE = 1e-8
SHORTEST_STEP = 0.005
LET_STAND = 0.5  # of a bound's tolerance
PATIENCE = 6  # steps
NEAR = 1e3  # times the tolerances: the end of a solve
ENOUGH = 0.05  # of the objective: what a further step must gain


@dataclass(frozen=True)
class Step:
    """One step: worst violation over its tolerance before the step, and the length taken."""

    stage: str
    violation: float
    length: float


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


Progress = Callable[[Step], None]


class Goal(Protocol):
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
        d, _ = line.step(value)
        at = _shorten(transcription, line, x, d, places, value, whole=slow)
        if at.length < 1.0 and not fresh:  # the old Jacobian no longer serves
            x, value, here, stale = at.x, at.value, None, True
            continue
        x, value, here, length = at.x, at.value, at.rows, at.length
        steps.append(Step(stage, violation, length))
        last = violation
        if progress is not None:
            progress(steps[-1])
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
    goal: Goal,
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
        steps.append(Step(stage, line.worst(rows.value), length))
        if progress is not None:
            progress(steps[-1])
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
class _Windows:
    """Rows gathered span by span: J (S, R, 4 n), zero where a span has fewer."""

    J: FloatArray
    counts: IntArray  # (S,) rows of each span
    first: IntArray  # (S,) first block of each span
    size: int
    where: tuple[IntArray, IntArray]  # of each row: its span, its place there

    @staticmethod
    def of(rows: Rows, norm: FloatArray, first: IntArray, basis: FloatArray | None) -> "_Windows":
        """Sorts rows, in units of norm (R,), by span."""
        order = np.argsort(rows.span, kind="stable")
        counts = np.bincount(rows.span, minlength=len(first))
        before = np.concatenate([[0], np.cumsum(counts)])
        place = np.empty(len(order), dtype=int)
        place[order] = np.arange(len(order)) - before[rows.span[order]]
        jacobian = rows.jacobian if basis is None else rows.jacobian @ basis
        n = jacobian.shape[2]
        J = np.zeros((len(first), counts.max(initial=0), ORDER * n))
        J[rows.span, place] = jacobian.reshape(len(order), -1) / norm[:, None]
        return _Windows(J, counts, first, n, (rows.span, place))

    def times(self, d: FloatArray) -> FloatArray:
        """J d, (S, R), of d (K, n)."""
        local = d[self.first[:, None] + np.arange(ORDER)].reshape(len(self.J), -1, 1)
        return np.asarray((self.J @ local)[..., 0])

    def transposed(self, y: FloatArray, blocks: int) -> FloatArray:
        """J' y, (K, n), of y (S, R)."""
        local = (y[:, None] @ self.J).reshape(len(self.J), ORDER, self.size)
        total = np.zeros((blocks, self.size))
        for k in range(ORDER):
            total[self.first + k] += local[:, k]
        return total

    def add_normal(self, system: BlockBanded, weight: float) -> None:
        """Adds weight * J'J, a few spans at a time so that they stay in the processor's cache."""
        wide = self.J.shape[2]
        scaled = np.sqrt(weight) * self.J
        squares = np.empty((AT_ONCE, wide, wide))

        def square(part: slice) -> None:
            for i in range(part.start, part.stop):  # numpy knows that a.T @ a is symmetric
                rows = scaled[first + i, : self.counts[first + i]]
                np.matmul(rows.T, rows, out=squares[i])

        for first in range(0, len(self.J), AT_ONCE):
            count = min(AT_ONCE, len(self.J) - first)
            in_threads(square, count, FEWEST_EACH)
            shape = (count, ORDER, self.size, ORDER, self.size)
            system.add_windows(self.first[first : first + count], squares[:count].reshape(shape))

    def columns(self, rows: IntArray, blocks: int) -> FloatArray:
        """(K, n, m) the chosen rows as columns."""
        span, place = (index[rows] for index in self.where)
        local = self.J[span, place].reshape(len(rows), ORDER, self.size)
        columns = np.zeros((blocks, self.size, len(rows)))
        for k in range(ORDER):
            columns[self.first[span] + k, :, np.arange(len(rows))] = local[:, k]
        return columns


def _factor(system: BlockBanded) -> Factor:
    """Cholesky; far from any motion rounding can spoil it, and a small ridge mends that."""
    try:
        return system.factor()
    except np.linalg.LinAlgError:
        system.add_diagonal(RIDGE * np.diagonal(system.lower[0], axis1=1, axis2=2))
        return system.factor()


class Linearised:
    """Rows linearised at one point, with the factor of W + rho J'J, ready for steps.

    basis: (n_block, k) the changes of a block that are allowed, None all. working: (R,) the rows
    that were at their bounds in the last step.
    """

    def __init__(
        self,
        transcription: Transcription,
        rows: Rows,
        metric: BlockBanded,
        *,
        basis: FloatArray | None = None,
        working: BoolArray | None = None,
    ) -> None:
        self._transcription, self._basis = transcription, basis
        self.rows = rows
        self._metric = metric if basis is None else metric.changed(basis)
        self._blocks = transcription.basis.n_coefficients
        self._norm = by_kind(rows.kind, NORM)
        self._tolerance = rows.tolerance
        first = transcription.basis.first_coefficient
        self._equal = np.flatnonzero(rows.equal)
        self._free = np.flatnonzero(~rows.equal)
        self._equations = _Windows.of(rows.some(self._equal), self._norm[self._equal], first, basis)
        system = self._metric.copy()
        self._equations.add_normal(system, PENALTY)
        self._factor = _factor(system)
        bounds = _Windows.of(rows.some(self._free), self._norm[self._free], first, basis)
        self._bounds, blocks = bounds, self._blocks
        was = np.zeros(len(self._free), bool) if working is None else working[self._free]
        self._bounded = BoundedStep(
            self._factor,
            lambda rows: bounds.columns(rows, blocks),  # not self: a cycle would live on for long
            (self._scaled(rows.lower, self._free), self._scaled(rows.upper, self._free)),
            self._scaled(self._tolerance, self._free),
            was,
        )

    @property
    def working(self) -> BoolArray:
        """(R,) the rows that the last step has at a bound."""
        working = np.zeros(len(self.rows.value), dtype=bool)
        working[self._free] = self._bounded.working
        return working

    def worst(self, value: FloatArray) -> float:
        """The worst violation over its tolerance; at most 1 means that all rows hold."""
        return float((np.abs(self.rows.violation(value)) / self._tolerance).max())

    def merit(self, value: FloatArray) -> float:
        """The summed squared violations in units of NORM (thesis eq. 4.6).

        What a bound's tolerance lets stand counts nothing: it is large beside the equations'.
        """
        off = np.abs(self.rows.violation(value))
        off[self._free] = np.maximum(off[self._free] - LET_STAND * self._tolerance[self._free], 0.0)
        return float(((off / self._norm) ** 2).sum())

    def total(self, value: FloatArray) -> float:
        """The summed violations in units of NORM."""
        return float((np.abs(self.rows.violation(value)) / self._norm).sum())

    def _scaled(self, values: FloatArray, rows: IntArray) -> FloatArray:
        return np.asarray(values[rows] / self._norm[rows])

    def step(
        self,
        value: FloatArray,
        gradient: FloatArray | None = None,
        multipliers: FloatArray | None = None,
    ) -> tuple[FloatArray, FloatArray]:
        """Step d (K, n_block) and multipliers (R,) of the rows in units of NORM.

        Augmented Lagrangian: repeat d = -(W + rho J'J)^-1 (g + J'(y + rho r)) within the bounds,
        y += rho (r + J d), until the linearised equations hold a thousand times better than
        before. gradient: g, None for the minimum-norm step.
        """
        windows = self._equations
        r = np.zeros(windows.J.shape[:2])
        r[windows.where] = self._scaled(value - self.rows.lower, self._equal)
        y = np.zeros_like(r)
        if multipliers is not None:
            y[windows.where] = multipliers[self._equal]
        if gradient is not None and self._basis is not None:
            gradient = gradient @ self._basis
        d = np.zeros((self._blocks, windows.size))
        missing = r
        enough = max(1e-9, SWEEP_GAIN * float(np.abs(missing).max()))
        z = self._scaled(value, self._free)
        for sweep in range(MOST_SWEEPS):
            slope = windows.transposed(y + PENALTY * missing, self._blocks)
            if sweep:
                slope += self._metric.times(d)
            if gradient is not None:
                slope += gradient
            d = d - self._factor.solve(slope)
            if len(z):
                d = d + self._bounded.correct(z + self._bound_values(d), self._bound_values)
            missing = r + windows.times(d)
            y += PENALTY * missing
            if np.abs(missing).max() < enough:
                break
        found = np.zeros(len(value))
        found[self._equal] = y[windows.where]
        found[self._free] = self._bounded.multipliers
        return d if self._basis is None else d @ self._basis.T, found

    def _bound_values(self, d: FloatArray) -> FloatArray:
        """B_x d, (R_bounds,)."""
        return np.asarray(self._bounds.times(d)[self._bounds.where])


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
    goal: Goal,
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
