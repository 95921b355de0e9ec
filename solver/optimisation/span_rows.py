"""Jacobian of chosen rows, gathered span by span: what banded systems are made of."""

from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray, IntArray
from ..numerics.block_banded import BlockBanded, LocalColumns
from ..numerics.splines import ORDER
from ..transcription.rows import Rows

AT_ONCE = 1000  # rows that are sorted; all at once would be a copy of them all


@dataclass(frozen=True)
class SpanRows:
    """J (S, R, 4 n), zero where a span has fewer rows than R."""

    J: FloatArray
    counts: IntArray  # (S,) rows of each span
    first: IntArray  # (S,) first block of each span
    size: int
    where: tuple[IntArray, IntArray]  # of each row: its span, its place there

    @staticmethod
    def of(
        rows: Rows,
        chosen: IntArray,
        scale: FloatArray,
        first: IntArray,
        basis: FloatArray | None,
        into: "SpanRows | None" = None,
    ) -> "SpanRows":
        """Sorts the chosen rows (m,), in units of scale (m,), by span. into: an earlier one that
        is no more; of as many rows a span, its memory is taken, for new memory costs more."""
        span = rows.span[chosen]
        order = np.argsort(span, kind="stable")
        counts = np.bincount(span, minlength=len(first))
        before = np.concatenate([[0], np.cumsum(counts)])
        place = np.empty(len(order), dtype=int)
        place[order] = np.arange(len(order)) - before[span[order]]
        n = rows.jacobian.shape[2] if basis is None else basis.shape[1]
        shape = (len(first), counts.max(initial=0), ORDER * n)
        alike = into is not None and into.J.shape == shape and (into.counts == counts).all()
        J = into.J if into is not None and alike else np.zeros(shape)
        for start in range(0, len(chosen), AT_ONCE):
            some = slice(start, start + AT_ONCE)
            jacobian = rows.jacobian[chosen[some]]
            jacobian = jacobian if basis is None else jacobian @ basis
            J[span[some], place[some]] = jacobian.reshape(len(jacobian), ORDER * n)
        other = scale != 1.0  # few; all rows once more would be a copy of them all
        J[span[other], place[other]] /= scale[other, None]
        return SpanRows(J, counts, first, n, (span, place))

    def times(self, d: FloatArray) -> FloatArray:
        """(S, R) product J d, of d (K, n)."""
        local = d[self.first[:, None] + np.arange(ORDER)].reshape(len(self.J), -1, 1)
        return np.asarray((self.J @ local)[..., 0])

    def transposed(self, y: FloatArray, blocks: int) -> FloatArray:
        """(K, n) product J' y, of y (S, R)."""
        local = (y[:, None] @ self.J).reshape(len(self.J), ORDER, self.size)
        total = np.zeros((blocks, self.size))
        for k in range(ORDER):
            total[self.first + k] += local[:, k]
        return total

    def add_normal(self, system: BlockBanded, weight: float) -> None:
        """Adds weight * J'J."""
        system.add_squares(self.first, self.J, self.counts, weight)

    @property
    def begins(self) -> IntArray:
        """(R,) first block of each row."""
        return np.asarray(self.first[self.where[0]])

    def columns(self, rows: IntArray) -> LocalColumns:
        """Columns of J' of the chosen rows (m,)."""
        span, place = (index[rows] for index in self.where)
        local = self.J[span, place].reshape(len(rows), ORDER, self.size)
        first = self.first[span] - self.first[span].min()
        columns = np.zeros((first.max() + ORDER, self.size, len(rows)))
        for k in range(ORDER):
            columns[first + k, :, np.arange(len(rows))] = local[:, k]
        return LocalColumns(int(self.first[span].min()), columns)
