"""Cholesky factorisation of block-banded SPD matrices, by OpenBLAS.

Splines make every matrix of the method banded in time: coefficients four apart do not meet. So
the unknowns are ordered by time in K blocks of n, and a block row holds at most `band` blocks
left of its diagonal: three, or four where neighbouring spans are compared with each other.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from .openblas import openblas, product

BANDWIDTH = 3
NEGLIGIBLE = 1e-6  # of a column's length
LOOK = 8  # blocks, after which a substitution looks whether it may end
REACH = 64  # blocks that there is room for at once; most substitutions need as many


class BlockBanded:
    """Symmetric block-banded matrix of K blocks of n by n unknowns.

    lower: (band + 1, K, n, n); lower[j][k] is the block in row k + j, column k.
    """

    def __init__(self, blocks: int, size: int, band: int = BANDWIDTH) -> None:
        # The blocks of a column lie together, as they are factored, with columns of zeros at the
        # end so that all are alike.
        self._columns = np.zeros((blocks + band, band + 1, size, size))
        self.lower = np.moveaxis(self._columns[:blocks], 1, 0)

    @property
    def band(self) -> int:
        """Block half-bandwidth: blocks left of the diagonal."""
        return len(self.lower) - 1

    @property
    def _stacked(self) -> FloatArray:
        """(K + band, (band + 1) n, n) block columns."""
        return self._columns.reshape(len(self._columns), -1, self._columns.shape[3])

    def copy(self, band: int | None = None, into: "BlockBanded | None" = None) -> "BlockBanded":
        """Deep copy, optionally with a wider band. into: one of the same shape to be overwritten,
        for memory that is new costs as much as the copy."""
        _, blocks, size, _ = self.lower.shape
        twin = (
            BlockBanded(blocks, size, self.band if band is None else band) if into is None else into
        )
        twin.lower[: self.band + 1] = self.lower
        twin.lower[self.band + 1 :] = 0.0
        twin._columns[blocks:] = 0.0
        return twin

    def part(self, blocks: slice, free: BoolArray) -> "BlockBanded":
        """The square of some blocks, in which those that are not free (by flags) couple with none
        and have ones on their diagonal."""
        _, size = self.lower.shape[1:3]
        twin = BlockBanded(blocks.stop - blocks.start, size, self.band)
        twin.lower[:] = self.lower[:, blocks]
        for j in range(self.band + 1):
            beyond = np.append(~free, np.ones(j, dtype=bool))[j:]
            twin.lower[j, ~free | beyond] = 0.0
        twin.add_diagonal(np.repeat(~free[:, None], size, axis=1).astype(float))
        return twin

    def cleared(self) -> "BlockBanded":
        """Itself with zeros, for memory that is new costs more."""
        self._columns[:] = 0.0
        return self

    def add_windows(self, first: IntArray, windows: FloatArray, part: slice = slice(None)) -> None:
        """Assembly: adds dense (S, w, n, w, n) windows at block rows first (S,).

        w is at most band + 1; first holds no index twice. part: the unknowns of each block that
        the windows' n stand for.
        """
        for row in range(windows.shape[1]):
            for column in range(row + 1):
                block = self.lower[row - column][:, part, part]
                block[first + column] += windows[:, row, :, column, :]

    def add_squares(
        self, first: IntArray, J: FloatArray, counts: IntArray, weight: float = 1.0
    ) -> None:
        """Assembly: adds weight J'J of each window's first counts (S,) rows of J (S, R, w n) at
        block rows first (S,), w at most band + 1."""
        openblas().add_squares(self._stacked, first, J, counts, weight)

    def congruent(self, change: FloatArray) -> "BlockBanded":
        """Congruence T' A T, block by block, with T (n, k), a basis of every block's unknowns."""
        twin = BlockBanded(self.lower.shape[1], change.shape[1], self.band)
        twin.lower[:] = change.T @ self.lower @ change
        return twin

    def add_diagonal(self, values: FloatArray) -> None:
        """Adds (K, n) values to the diagonal."""
        index = np.arange(values.shape[1])
        self.lower[0][:, index, index] += values

    def times(self, x: FloatArray) -> FloatArray:
        """Matrix-vector product (K, n) with x (K, n)."""
        lower = self.lower
        y = (lower[0] @ x[..., None])[..., 0]
        for j in range(1, self.band + 1):
            y[j:] += (lower[j][:-j] @ x[:-j, :, None])[..., 0]
            y[:-j] += (x[j:, None] @ lower[j][:-j])[:, 0]
        return np.asarray(y)

    def factor(self, *, overwrite: bool = False) -> "CholeskyFactor":
        """Cholesky factor, right-looking by blocks (Golub and Van Loan 2013, ch. 4.3).

        overwrite: whether the factor may take the place of the matrix, which then is no more.
        Raises numpy.linalg.LinAlgError if the matrix is not positive definite.
        """
        if not overwrite:
            return self.copy().factor(overwrite=True)
        band, count, n, _ = (self.band, *self.lower.shape[1:])
        # To unit diagonal first: a force's and an angle's differ by 1e9, and inverting blocks that
        # are scaled as badly loses the small unknowns (Higham 2002, 10.1).
        diagonal = np.diagonal(self.lower[0], axis1=1, axis2=2)
        if not (diagonal > 0.0).all():
            raise np.linalg.LinAlgError("the matrix is not positive definite")
        share = np.concatenate([1.0 / np.sqrt(diagonal), np.ones((band, n))])  # (K + band, n)
        columns, blas = self._stacked, openblas()
        for k in range(min(band, count)):
            _to_unit_diagonal(columns[k], share, k)
        for k in range(count):
            # What is used together stays in the processor's cache.
            if k + band < count:
                _to_unit_diagonal(columns[k + band], share, k + band)
            blas.eliminate(columns, k)
        return CholeskyFactor(columns[:count], share[:count])


def _to_unit_diagonal(column: FloatArray, share: FloatArray, k: int) -> None:
    """Scales block column k ((band + 1) n, n) in place. share: (K + band, n), of the unknowns."""
    n = column.shape[1]
    column *= share[k : k + len(column) // n].reshape(-1, 1)
    column *= share[k]


@dataclass(frozen=True)
class LocalColumns:
    """Columns (w, n, m) that are zero, or negligible, but in w blocks from block `first` on."""

    first: int
    values: FloatArray

    def products(self, other: "LocalColumns") -> FloatArray:
        """(m, m') scalar products with other columns."""
        first = max(self.first, other.first)
        last = min(each.first + len(each.values) for each in (self, other))
        mine, others = (
            each.values[first - each.first : max(first, last) - each.first]
            for each in (self, other)
        )
        # Not by tensordot, which copies both: as they lie they are matrices.
        mine, others = (each.reshape(-1, each.shape[2]) for each in (mine, others))
        return product(mine.T, others)

    def add_times(self, weights: FloatArray, total: FloatArray) -> None:
        """Adds the columns' sum by weights (m,) to total (K, n)."""
        total[self.first : self.first + len(self.values)] += self.values @ weights

    def transposed_times(self, x: FloatArray) -> FloatArray:
        """(m,) scalar products with x (K, n)."""
        count, _, m = self.values.shape
        return np.asarray(x[self.first : self.first + count].ravel() @ self.values.reshape(-1, m))


@dataclass(frozen=True)
class CholeskyFactor:
    """Block Cholesky factor L = S C. columns: (K, (1 + band) n, n), of C the inverse of each
    diagonal block, in its lower triangle, and the blocks below it, zeros beyond the last row.
    share: (K, n), the diagonal of S^-1."""

    columns: FloatArray
    share: FloatArray

    @property
    def shape(self) -> tuple[int, int]:
        """K blocks of n unknowns."""
        count, _, size = self.columns.shape
        return count, size

    @property
    def _below(self) -> int:
        """Rows below a diagonal block."""
        return self.columns.shape[1] - self.columns.shape[2]

    def solve(self, b: FloatArray) -> FloatArray:
        """x of A x = b, both (K, n) or (K, n, m)."""
        return self.backward(self.forward(b))

    def forward(self, b: FloatArray) -> FloatArray:
        """Forward substitution L^-1 b, b (K, n) or (K, n, m)."""
        x = self._padded(b)
        x[: -self._below] *= self.share.reshape(-1, 1)
        openblas().forward(self.columns, x)
        return np.asarray(x[: -self._below].reshape(b.shape))

    def forward_locally(self, b: LocalColumns) -> LocalColumns:
        """Forward substitution as far as any column has more than NEGLIGIBLE of its length.

        What is far off in time hardly couples. Each block follows from the `band` before it: where
        these are negligible, so is what follows.
        """
        n, below, m = self.shape[1], self._below, b.values.shape[2]
        share = self.share[b.first : b.first + len(b.values)]
        x = (b.values * share[..., None]).reshape(-1, m)
        squared, done, columns = np.zeros(m), 0, self.columns[b.first :]
        while done < len(columns):
            until = min(max(done + LOOK, len(b.values)), len(columns))
            if len(x) < until * n + below:
                x = np.concatenate([x, np.zeros((REACH * n + below, m))])
            openblas().forward(columns[done:until], x[done * n :])
            squared += (x[done * n : until * n] ** 2).sum(axis=0)
            tail = (x[until * n - below : until * n] ** 2).sum(axis=0)
            done = until
            if (tail <= NEGLIGIBLE**2 * squared).all():
                break
        return LocalColumns(b.first, x[: done * n].reshape(done, n, m))

    def backward(self, b: FloatArray) -> FloatArray:
        """Back substitution L^-T b, b (K, n) or (K, n, m)."""
        x = self._padded(b)
        openblas().backward(self.columns, x)
        return np.asarray((x[: -self._below] * self.share.reshape(-1, 1)).reshape(b.shape))

    def _padded(self, b: FloatArray) -> FloatArray:
        """((K + band) n, m), m one where there is none: the right side, then zeros."""
        rows = b.reshape(b.shape[0] * b.shape[1], -1)
        return np.concatenate([rows, np.zeros((self._below, rows.shape[1]))])
