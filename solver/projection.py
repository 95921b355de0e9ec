"""Steps towards a motion that satisfies every equation (thesis 4.2 and 4.4).

Each step solves the linearised problem

    min  g . d + 1/2 d . W d   subject to   C(x) + C_x d = 0

with W the metric of closeness.py. With g the gradient of the distance to a target this *projects*
the target onto the valid motions (the fit); with g = 0 it is the thesis's minimum-norm step (the
implicit solution), which converges quadratically and stays near where it began.

The equality problem is solved by an augmented Lagrangian on one banded factor, which also settles
redundant rows (two feet planted, pins on one rigid foot) without choosing among them.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .closeness import Closeness
from .linear import BlockBanded, Factor
from .recording import FloatArray, IntArray
from .rows import RowKind, Rows
from .splines import ORDER
from .status import Status
from .transcription import Transcription

# The largest violation that is let stand, by kind, in the kind's unit.
TOLERANCE = {
    RowKind.BALANCE: 1e-5,
    RowKind.MOMENT: 2e-5,
    RowKind.PIN: 1e-5,
    RowKind.PIN_SPEED: 1e-3,
    RowKind.RELEASE: 1e-4,
}
# Speeds are weighed against places by the time in which they would move as far.
NORM = {RowKind.PIN_SPEED: 30.0}
PENALTY = 1e2
MOST_SWEEPS = 8
SWEEP_GAIN = 1e-3
CHORD_GAIN = 0.03
RIDGE = 1e-8
SHORTEST_STEP = 0.005
PULL_TOLERANCE = 0.01  # BW
NEAR = 1e3  # times the tolerances: near enough to tell which forces pull
ENOUGH = 0.05  # of the distance to the target: what a further step must gain


@dataclass(frozen=True)
class Step:
    """One step: worst violation over its tolerance before the step, and the length taken."""

    stage: str
    violation: float
    length: float


@dataclass(frozen=True)
class Outcome:
    """Where the steps ended: unknowns, equations (some forces may be released), how and why."""

    x: FloatArray
    transcription: Transcription
    status: Status
    steps: tuple[Step, ...]
    violation: float


Progress = Callable[[Step], None]


def restore(
    transcription: Transcription,
    metric: BlockBanded,
    x: FloatArray,
    places: FloatArray,
    *,
    stage: str,
    most_steps: int = 30,
    progress: Progress | None = None,
) -> Outcome:
    """Minimum-norm steps until the equations hold; forces that pull are released on the way.

    metric: W, fixed. places: (n_contacts, 3) m. A line search on the summed squared violation
    guards the steps (thesis eq. 4.6). While steps gain an order of magnitude, the next one uses
    the same Jacobian and factor, which costs a third of a new one (chord steps).
    """
    steps: list[Step] = []
    status = Status.TOO_MANY_STEPS
    line = Linearised(transcription, transcription.rows(x, places), metric)
    residual, fresh, last = line.rows.residual, True, np.inf
    while len(steps) < most_steps:
        violation = line.worst(residual)
        if violation <= NEAR:
            pulling = transcription.pulling(x, PULL_TOLERANCE) - transcription.released
            if pulling:
                transcription = transcription.release(pulling)
                rows = transcription.rows(x, places)
                line, fresh = Linearised(transcription, rows, metric), True
                residual = rows.residual
                violation = line.worst(residual)
        if violation <= 1.0:
            status = Status.SOLVED
            break
        if not fresh and violation > CHORD_GAIN * last:
            line, fresh = Linearised(transcription, transcription.rows(x, places), metric), True
        d, _ = line.step(residual)
        x, residual, length = _shorten(transcription, line, x, d, places, residual)
        if length < 1.0 and not fresh:  # the old Jacobian no longer serves
            line, fresh = Linearised(transcription, transcription.rows(x, places), metric), True
            continue
        steps.append(Step(stage, violation, length))
        last, fresh = violation, False
        if progress is not None:
            progress(steps[-1])
        if length == 0.0:
            status = Status.STALLED
            break
    return Outcome(x, transcription, status, tuple(steps), line.worst(residual))


def project(
    transcription: Transcription,
    closeness: Closeness,
    x: FloatArray,
    places: FloatArray,
    *,
    stage: str,
    most_steps: int,
    progress: Progress | None = None,
) -> Outcome:
    """Steps towards the valid motion nearest to the target; `restore` finishes what they leave.

    Ends when a step changes the distance little; the equations then nearly hold.
    """
    steps: list[Step] = []
    status = Status.TOO_MANY_STEPS
    multipliers: FloatArray | None = None
    objective = closeness.value(x)
    for _ in range(most_steps):
        rows = transcription.rows(x, places)
        gradient, metric = closeness.expand(x)
        line = Linearised(transcription, rows, metric)
        d, multipliers = line.step(rows.residual, gradient, multipliers)
        x, length = _search(transcription, closeness, x, d, places, rows, multipliers, objective)
        steps.append(Step(stage, worst_violation(rows), length))
        if progress is not None:
            progress(steps[-1])
        before, objective = objective, closeness.value(x)
        if length == 0.0 or (len(steps) > 1 and abs(before - objective) < ENOUGH * before):
            status = Status.SOLVED
            break
    violation = worst_violation(transcription.rows(x, places))
    return Outcome(x, transcription, status, tuple(steps), violation)


def worst_violation(rows: Rows) -> float:
    """The worst violation over its kind's tolerance; at most 1 means that the equations hold."""
    return float((np.abs(rows.residual) / _by_kind(rows, TOLERANCE)).max())


def _by_kind(rows: Rows, sizes: dict[RowKind, float]) -> FloatArray:
    values = np.ones(len(rows.residual))
    for kind, size in sizes.items():
        values[rows.kind == kind] = size
    return values


@dataclass(frozen=True)
class _Windows:
    """Rows gathered span by span: J (S, R, 4 n), zero where a span has fewer."""

    J: FloatArray
    counts: IntArray  # (S,) rows of each span
    first: IntArray  # (S,) first block of each span
    size: int

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

    def normal(self, weight: float) -> FloatArray:
        """weight * J'J of each span, (S, 4, n, 4, n)."""
        scaled = np.sqrt(weight) * self.J
        squares = np.empty((len(self.J), self.J.shape[2], self.J.shape[2]))
        for span, count in enumerate(self.counts):  # numpy knows that a.T @ a is symmetric
            squares[span] = scaled[span, :count].T @ scaled[span, :count]
        return np.asarray(squares.reshape(len(self.J), ORDER, self.size, ORDER, self.size))


def _factor(system: BlockBanded) -> Factor:
    """Cholesky; far from any motion rounding can spoil it, and a small ridge mends that."""
    try:
        return system.factor()
    except np.linalg.LinAlgError:
        system.add_diagonal(RIDGE * np.diagonal(system.lower[0], axis1=1, axis2=2))
        return system.factor()


class Linearised:
    """Rows linearised at one point, with the factor of W + rho J'J, ready for steps."""

    def __init__(self, transcription: Transcription, rows: Rows, metric: BlockBanded) -> None:
        self.rows = rows
        self.metric = metric
        self.tolerance = _by_kind(rows, TOLERANCE)
        self._norm = _by_kind(rows, NORM)
        self._blocks = transcription.basis.n_coefficients
        self._gather(transcription)
        system = metric.copy()
        system.add_windows(self._windows.first, self._windows.normal(PENALTY))
        self._factor = _factor(system)

    def _gather(self, transcription: Transcription) -> None:
        """Sorts the rows, in units of NORM, by span."""
        rows, basis = self.rows, transcription.basis
        order = np.argsort(rows.span, kind="stable")
        counts = np.bincount(rows.span, minlength=basis.n_spans)
        first = np.concatenate([[0], np.cumsum(counts)])
        place = np.empty(len(order), dtype=int)
        place[order] = np.arange(len(order)) - first[rows.span[order]]
        self._where = (rows.span, place)
        n = rows.jacobian.shape[2]
        J = np.zeros((basis.n_spans, counts.max(), ORDER * n))
        J[self._where] = rows.jacobian.reshape(len(order), -1) / self._norm[:, None]
        self._windows = _Windows(J, counts, basis.first_coefficient, n)

    def worst(self, residual: FloatArray) -> float:
        """The worst violation over its kind's tolerance; at most 1 means that all hold."""
        return float((np.abs(residual) / self.tolerance).max())

    def step(
        self,
        residual: FloatArray,
        gradient: FloatArray | None = None,
        multipliers: FloatArray | None = None,
    ) -> tuple[FloatArray, FloatArray]:
        """Step d (K, n_block) and multipliers (R,) of the rows in units of NORM.

        Augmented Lagrangian: repeat d = -(W + rho J'J)^-1 (g + J'(y + rho r)), y += rho (r + J d),
        until the linearised equations hold a thousand times better than before. gradient: g, None
        for the minimum-norm step.
        """
        windows = self._windows
        r = np.zeros(windows.J.shape[:2])
        r[self._where] = residual / self._norm
        y = np.zeros_like(r)
        if multipliers is not None:
            y[self._where] = multipliers
        d = np.zeros((self._blocks, windows.size))
        missing = r
        enough = max(1e-9, SWEEP_GAIN * float(np.abs(missing).max()))
        for sweep in range(MOST_SWEEPS):
            slope = windows.transposed(y + PENALTY * missing, self._blocks)
            if sweep:
                slope += self.metric.times(d)
            if gradient is not None:
                slope += gradient
            d -= self._factor.solve(slope)
            missing = r + windows.times(d)
            y += PENALTY * missing
            if np.abs(missing).max() < enough:
                break
        return d, y[self._where]


def _shorten(
    transcription: Transcription,
    line: Linearised,
    x: FloatArray,
    d: FloatArray,
    places: FloatArray,
    residual: FloatArray,
) -> tuple[FloatArray, FloatArray, float]:
    """The longest of d, d/2, d/4 … that lessens the summed squared violation; 0.0 if none does.

    Returns the new unknowns, their residual and the length.
    """
    before = float(((residual / line.tolerance) ** 2).sum())
    length = 1.0
    while length > SHORTEST_STEP:
        trial = x + length * d
        left = transcription.residuals(trial, places)
        if float(((left / line.tolerance) ** 2).sum()) < (1.0 - 0.1 * length) * before:
            return trial, left, length
        length *= 0.5
    return x, residual, 0.0


def _search(
    transcription: Transcription,
    closeness: Closeness,
    x: FloatArray,
    d: FloatArray,
    places: FloatArray,
    rows: Rows,
    multipliers: FloatArray,
    objective: float,
) -> tuple[FloatArray, float]:
    """Backtracks on distance plus weighted violation (an exact l1 merit function)."""
    norm = _by_kind(rows, NORM)
    weight = 2.0 * float(np.abs(multipliers).max()) + 1e-9
    before = objective + weight * float(np.abs(rows.residual / norm).sum())
    length = 1.0
    while length > 0.1:
        trial = x + length * d
        violation = float(np.abs(transcription.residuals(trial, places) / norm).sum())
        if closeness.value(trial) + weight * violation < before:
            return trial, length
        length *= 0.5
    return x, 0.0
