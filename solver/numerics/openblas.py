"""OpenBLAS by ctypes: the dense products and factors, of the wheel scipy-openblas32.

What numpy was built with is chance: Blender's and Debian's have no tuned BLAS, and pip's may be
older than the processor, which it then takes for one of 2004. BLAS knows arrays by rows, LAPACK by
columns only: its upper triangle is our lower one.
"""

import ctypes
from enum import IntEnum
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray

LIBRARY = "libscipy_openblas"


class Blas(IntEnum):
    """The choices of `cblas.h`."""

    ROWS = 101
    COLUMNS = 102
    PLAIN = 111
    TRANSPOSED = 112
    LOWER = 122
    NON_UNIT = 131
    LEFT = 141
    RIGHT = 142


class OpenBlas:
    """Dense products and factors of doubles, on one thread."""

    def __init__(self, file: Path) -> None:
        # Python's lock is held in its calls, most of which are shorter than letting it go.
        library = ctypes.PyDLL(str(file))
        library.scipy_openblas_set_num_threads(1)
        self._gemm, self._trmm = library.scipy_cblas_dgemm, library.scipy_cblas_dtrmm
        self._potrf = library.scipy_LAPACKE_dpotrf_work
        self._trtri = library.scipy_LAPACKE_dtrtri_work
        self._potrs = library.scipy_LAPACKE_dpotrs_work
        self._potri = library.scipy_LAPACKE_dpotri_work
        int_, char = ctypes.c_int, ctypes.c_char
        matrix: list[Any] = [ctypes.c_void_p, int_]
        scaled: list[Any] = [ctypes.c_double, *matrix]
        self._gemm.argtypes = [*[int_] * 6, *scaled, *matrix, *scaled]
        self._trmm.argtypes = [*[int_] * 7, *scaled, *matrix]
        self._potrf.argtypes = [int_, char, int_, *matrix]
        self._trtri.argtypes = [int_, char, char, int_, *matrix]
        self._potrs.argtypes = [int_, char, int_, int_, *matrix, *matrix]
        self._potri.argtypes = [int_, char, int_, *matrix]

    def product(self, a: FloatArray, b: FloatArray) -> FloatArray:
        """a @ b (m, n), of a (m, k) and b (k, n) whose rows or columns are contiguous."""
        (m, k), n = a.shape, b.shape[1]
        if len(b) != k:
            raise ValueError(f"{a.shape} @ {b.shape}")
        if 0 in (m, n, k):
            return np.zeros((m, n))
        out = np.empty((m, n))
        (by_a, *at_a), (by_b, *at_b), (_, *at) = _layout(a), _layout(b), _layout(out)
        self._gemm(Blas.ROWS, by_a, by_b, m, n, k, 1.0, *at_a, *at_b, 0.0, *at)
        return out

    def add_squares(
        self, columns: FloatArray, first: IntArray, J: FloatArray, counts: IntArray, weight: float
    ) -> None:
        """Adds weight J'J to block columns, in their lower triangle.

        columns: (K, (1 + band) n, n). J: (S, R, w n), of which the first counts (S,) rows count,
        w at most 1 + band; contiguous. first: (S,) block at which each J'J begins.
        """
        n, wide, step = columns.shape[2], J.shape[2], columns.strides[0]
        row, to = J.ctypes.data, columns.ctypes.data
        square = (Blas.ROWS, Blas.TRANSPOSED, Blas.PLAIN)
        for k, count in zip(first.tolist(), counts.tolist(), strict=True):
            for j in range(wide // n if count else 0):
                at = row + 8 * j * n
                shape = (wide - j * n, n, count, weight, at, wide, at, wide)
                self._gemm(*square, *shape, 1.0, to + (k + j) * step, n)
            row += J.strides[0]

    def eliminate(self, columns: FloatArray, k: int) -> None:
        """A step of the block Cholesky factorisation, in place.

        columns: (K, (1 + band) n, n), contiguous, block columns from the diagonal down. In column k
        the lower triangle of the diagonal block becomes L^-1, of its Cholesky factor L, and the
        panel P below it P L^-T. The columns after it lose the square of that panel. Raises
        numpy.linalg.LinAlgError if the block is not positive definite.
        """
        n = columns.shape[2]
        band = columns.shape[1] // n - 1
        step, block = columns.strides[0], columns.strides[1] * n
        diagonal = columns.ctypes.data + k * step
        panel = diagonal + block
        if self._potrf(Blas.COLUMNS, b"U", n, diagonal, n) != 0:
            raise np.linalg.LinAlgError("the matrix is not positive definite")
        self._trtri(Blas.COLUMNS, b"U", b"N", n, diagonal, n)
        # A product with the inverse takes a quarter of the time of a solution with the factor.
        triangle = (Blas.ROWS, Blas.RIGHT, Blas.LOWER, Blas.TRANSPOSED, Blas.NON_UNIT)
        self._trmm(*triangle, band * n, n, 1.0, diagonal, n, panel, n)
        for j in range(band):
            row, rest = panel + j * block, (band - j) * n
            square = (Blas.ROWS, Blas.PLAIN, Blas.TRANSPOSED, rest, n, n, -1.0, row, n, row, n)
            self._gemm(*square, 1.0, diagonal + (1 + j) * step, n)

    def factor(self, matrix: FloatArray) -> None:
        """The Cholesky factor L of a matrix (n, n), contiguous, in its lower triangle. Raises
        numpy.linalg.LinAlgError if it is not positive definite."""
        n = len(matrix)
        if self._potrf(Blas.COLUMNS, b"U", n, matrix.ctypes.data, n) != 0:
            raise np.linalg.LinAlgError("the matrix is not positive definite")

    def solve(self, factor: FloatArray, x: FloatArray) -> None:
        """L^-T L^-1 x by such a factor L (n, n), in place. x: (n,), contiguous."""
        n = len(factor)
        self._potrs(Blas.COLUMNS, b"U", n, 1, factor.ctypes.data, n, x.ctypes.data, n)

    def invert(self, factor: FloatArray) -> None:
        """The lower triangle of L^-T L^-1 in place of such a factor's."""
        n = len(factor)
        if self._potri(Blas.COLUMNS, b"U", n, factor.ctypes.data, n) != 0:
            raise np.linalg.LinAlgError("the factor has a zero on its diagonal")

    def forward(self, columns: FloatArray, x: FloatArray) -> None:
        """Forward substitution by columns that were eliminated, in place.

        columns: (K, (1 + band) n, n), contiguous. x: ((K + band) n, m), contiguous.
        """
        n, m, column, below, row = _substitution(columns, x)
        triangle = (Blas.ROWS, Blas.LEFT, Blas.LOWER, Blas.PLAIN, Blas.NON_UNIT, n, m, 1.0)
        panel = (Blas.ROWS, Blas.PLAIN, Blas.PLAIN, below, m, n, -1.0)
        for _ in range(len(columns)):
            self._trmm(*triangle, column, n, row, m)
            after = row + 8 * n * m
            self._gemm(*panel, column + 8 * n * n, n, row, m, 1.0, after, m)
            column, row = column + columns.strides[0], after

    def backward(self, columns: FloatArray, x: FloatArray) -> None:
        """Back substitution, likewise."""
        n, m, column, below, row = _substitution(columns, x)
        triangle = (Blas.ROWS, Blas.LEFT, Blas.LOWER, Blas.TRANSPOSED, Blas.NON_UNIT, n, m, 1.0)
        panel = (Blas.ROWS, Blas.TRANSPOSED, Blas.PLAIN, n, m, below, -1.0)
        for k in reversed(range(len(columns))):
            at, to = column + k * columns.strides[0], row + 8 * k * n * m
            self._gemm(*panel, at + 8 * n * n, n, to + 8 * n * m, m, 1.0, to, m)
            self._trmm(*triangle, at, n, to, m)


def _substitution(columns: FloatArray, x: FloatArray) -> tuple[int, int, int, int, int]:
    """Unknowns of a block, right sides, address of the columns, rows of a panel, address of x."""
    n, m = columns.shape[2], x.shape[1]
    return n, m, columns.ctypes.data, columns.shape[1] - n, x.ctypes.data


def _layout(matrix: FloatArray) -> tuple[Blas, int, int]:
    """By rows or columns, address, and how many numbers one lies from the next."""
    size, (rows, columns), (down, right) = matrix.itemsize, matrix.shape, matrix.strides
    if right == size:
        return Blas.PLAIN, matrix.ctypes.data, max(down // size, columns)
    if down == size:
        return Blas.TRANSPOSED, matrix.ctypes.data, max(right // size, rows)
    raise ValueError("neither rows nor columns are contiguous")


@cache
def openblas() -> OpenBlas:
    """The process's own. Raises ImportError or OSError where the wheel is missing or broken."""
    import scipy_openblas32  # loaded where it computes alone, never in Blender's own process

    folder = Path(scipy_openblas32.get_lib_dir())
    files = (file for file in folder.glob(f"{LIBRARY}*") if file.suffix != ".lib")
    return OpenBlas(next(files, folder / LIBRARY))


def product(a: FloatArray, b: FloatArray) -> FloatArray:
    """a @ b of matrices whose rows or columns are contiguous."""
    return openblas().product(a, b)
