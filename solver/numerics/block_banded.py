"""Cholesky factorisation of block-banded SPD matrices, with numpy alone.

Splines make every matrix of the method banded in time: coefficients four apart do not meet. So
the unknowns are ordered by time in K blocks of n, and a block row holds at most `band` blocks
left of its diagonal: three, or four where neighbouring spans are compared with each other.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray, IntArray

BANDWIDTH = 3


class BlockBanded:
    """Symmetric block-banded matrix of K blocks of n by n unknowns.

    lower: (band + 1, K, n, n); lower[j][k] is the block in row k + j, column k.
    """

    def __init__(self, blocks: int, size: int, band: int = BANDWIDTH) -> None:
        self.lower = np.zeros((band + 1, blocks, size, size))

    @property
    def band(self) -> int:
        """Block half-bandwidth: blocks left of the diagonal."""
        return len(self.lower) - 1

    def copy(self, band: int | None = None) -> "BlockBanded":
        """Deep copy, optionally with a wider band."""
        _, blocks, size, _ = self.lower.shape
        twin = BlockBanded(blocks, size, self.band if band is None else band)
        twin.lower[: self.band + 1] = self.lower
        return twin

    def add_windows(self, first: IntArray, windows: FloatArray, part: slice = slice(None)) -> None:
        """Assembly: adds dense (S, w, n, w, n) windows at block rows first (S,).

        w is at most band + 1; first holds no index twice. part: the unknowns of each block that
        the windows' n stand for.
        """
        for row in range(windows.shape[1]):
            for column in range(row + 1):
                block = self.lower[row - column][:, part, part]
                block[first + column] += windows[:, row, :, column, :]

    def congruent(self, change: FloatArray) -> "BlockBanded":
        """Congruence T' A T, block by block, with T (n, k), a basis of every block's unknowns."""
        twin = BlockBanded(0, 0)
        twin.lower = change.T @ self.lower @ change
        return twin

    def add_diagonal(self, values: FloatArray) -> None:
        """Adds (K, n) values to the diagonal."""
        index = np.arange(values.shape[1])
        self.lower[0][:, index, index] += values

    def times(self, x: FloatArray) -> FloatArray:
        """Matrix-vector product (K, n) with x (K, n)."""
        lower = self.lower
        y = np.einsum("kij,kj->ki", lower[0], x)
        for j in range(1, self.band + 1):
            y[j:] += np.einsum("kij,kj->ki", lower[j][:-j], x[:-j])
            y[:-j] += np.einsum("kij,ki->kj", lower[j][:-j], x[j:])
        return np.asarray(y)

    def factor(self) -> "CholeskyFactor":
        """Cholesky factor, right-looking by blocks (Golub and Van Loan 2013, ch. 4.3).

        Raises numpy.linalg.LinAlgError if the matrix is not positive definite.
        """
        band, count, n, _ = (self.band, *self.lower.shape[1:])
        # To unit diagonal first: a force's and an angle's differ by 1e9, and inverting blocks that
        # are scaled as badly loses the small unknowns (Higham 2002, 10.1).
        diagonal = np.diagonal(self.lower[0], axis1=1, axis2=2)
        if not (diagonal > 0.0).all():
            raise np.linalg.LinAlgError("the matrix is not positive definite")
        size = np.concatenate([np.sqrt(diagonal), np.ones((band, n))])  # (K + band, n)
        # Blocks below each other lie together: column k is (band + 1) n by n. Some columns of zeros
        # at the end, so that all are alike.
        columns = np.zeros((count + band, band + 1, n, n))
        for j, below in enumerate(self.lower):
            scaled = below[: count - j] / size[j:count, :, None]
            columns[: count - j, j] = scaled / size[: count - j, None, :]
        columns = columns.reshape(count + band, (band + 1) * n, n)
        inverse = np.empty((count, n, n))
        for k in range(count):
            inverse[k] = np.linalg.inv(np.linalg.cholesky(columns[k, :n]))
            panel = columns[k, n:] @ inverse[k].T
            columns[k, n:] = panel
            update = panel @ panel.T
            for j in range(band):
                columns[k + 1 + j, : (band - j) * n] -= update[j * n :, j * n : (j + 1) * n]
            columns[k, n:] *= size[k + 1 : k + 1 + band].reshape(-1, 1)
            inverse[k] /= size[k]
        return CholeskyFactor(inverse, columns[:count, n:])


@dataclass(frozen=True)
class CholeskyFactor:
    """Block Cholesky factor L: inverses of its diagonal blocks and the blocks below them."""

    inverse: FloatArray  # (K, n, n)
    below: FloatArray  # (K, band n, n), zeros beyond the last row

    @property
    def shape(self) -> tuple[int, int]:
        """K blocks of n unknowns."""
        count, size, _ = self.inverse.shape
        return count, size

    def solve(self, b: FloatArray) -> FloatArray:
        """x of A x = b, both (K, n) or (K, n, m)."""
        return self.backward(self.forward(b))

    def forward(self, b: FloatArray) -> FloatArray:
        """Forward substitution L^-1 b, b (K, n) or (K, n, m)."""
        x, n = self._padded(b), b.shape[1]
        for k, (inverse, below) in enumerate(zip(self.inverse, self.below, strict=True)):
            first, last = k * n, (k + 1) * n
            x[first:last] = inverse @ x[first:last]
            x[last : last + len(below)] -= below @ x[first:last]
        return np.asarray(x[: len(b) * n].reshape(b.shape))

    def backward(self, b: FloatArray) -> FloatArray:
        """Back substitution L^-T b, b (K, n) or (K, n, m)."""
        x, n = self._padded(b), b.shape[1]
        for k in reversed(range(len(b))):
            first, last, below = k * n, (k + 1) * n, self.below[k]
            x[first:last] -= below.T @ x[last : last + len(below)]
            x[first:last] = self.inverse[k].T @ x[first:last]
        return np.asarray(x[: len(b) * n].reshape(b.shape))

    def _padded(self, b: FloatArray) -> FloatArray:
        """(K n + band n, m) or without m: the right side, then zeros."""
        rows = b.reshape(-1, *b.shape[2:])
        return np.concatenate([rows, np.zeros((self.below.shape[1], *b.shape[2:]))])
