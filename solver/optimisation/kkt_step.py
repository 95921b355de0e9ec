"""The linearised problem of a step, solved on one banded factor (thesis 4.4).

    min  g . d + 1/2 d . W d   subject to   C + C_x d = 0,   lo <= B + B_x d <= hi

The equations are settled by an augmented Lagrangian, which also settles redundant rows (two feet
planted, pins on one rigid foot) without choosing among them; the bounds by a small quadratic
program (qp.py).
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..data.row_kinds import RowKind
from ..numerics.block_banded import BlockBanded, CholeskyFactor
from ..numerics.parallel import in_threads
from ..numerics.splines import ORDER
from ..transcription.rows import Rows, by_kind
from ..transcription.transcription import Transcription
from .bounded_qp import BoundedStep

# Speeds are weighed against places by the time in which they would move as far.
NORM = {RowKind.PIN_SPEED: 30.0}
PENALTY = 1e4
AT_ONCE = 32  # spans
FEWEST_EACH = 8  # spans worth a thread of their own
MOST_SWEEPS = 8
SWEEP_GAIN = 1e-3
RIDGE = 1e-8
LET_STAND = 0.5  # of a bound's tolerance


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


def _factor(system: BlockBanded) -> CholeskyFactor:
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
        self._metric = metric if basis is None else metric.congruent(basis)
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

    def worst_name(self, value: FloatArray) -> str:
        """Whose the worst row is: a contact, a condition, or the equation's own name."""
        worst = int(np.argmax(np.abs(self.rows.violation(value)) / self._tolerance))
        owner = int(self.rows.owner[worst])
        kind: RowKind = self.rows.kind[worst]
        return self._transcription.owners[owner] if owner >= 0 else kind.label

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
