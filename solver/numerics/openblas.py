"""The OpenBLAS in CasADi's wheel, for a numpy that was built without a tuned BLAS.

Debian's numpy has the reference BLAS, Blender's may have none: with these a factor takes four to
eight times as long. Which of the two computes depends on the installation alone; results agree to
rounding. BLAS knows arrays by rows, LAPACK by columns only: its upper triangle is our lower one.
"""

import ctypes
from enum import IntEnum
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

import casadi as ca
import numpy as np

from ..arrays import FloatArray

FILES = ("libcasadi-tp-openblas.so.0", "libcasadi-tp-openblas.dll")  # wheels for macOS have none
TUNED = ("openblas", "accelerate", "mkl", "blis")


class Blas(IntEnum):
    """The choices of `cblas.h`."""

    ROWS = 101
    COLUMNS = 102
    PLAIN = 111
    TRANSPOSED = 112
    LOWER = 122
    NON_UNIT = 131
    RIGHT = 142


class OpenBlas:
    """Dense products and factors of doubles, on one thread."""

    def __init__(self, file: Path) -> None:
        # Python's lock is held in its calls: it was built without locks of its own.
        library = ctypes.PyDLL(str(file))
        library.openblas_set_num_threads(1)
        self._gemm, self._syrk = library.cblas_dgemm, library.cblas_dsyrk
        self._trsm, self._potrf = library.cblas_dtrsm, library.LAPACKE_dpotrf_work
        self._trtri = library.LAPACKE_dtrtri_work
        int_, char = ctypes.c_int, ctypes.c_char
        matrix: list[Any] = [ctypes.c_void_p, int_]
        scaled: list[Any] = [ctypes.c_double, *matrix]
        self._gemm.argtypes = [*[int_] * 6, *scaled, *matrix, *scaled]
        self._syrk.argtypes = [*[int_] * 5, *scaled, *scaled]
        self._trsm.argtypes = [*[int_] * 7, *scaled, *matrix]
        self._potrf.argtypes = [int_, char, int_, *matrix]
        self._trtri.argtypes = [int_, char, char, int_, *matrix]

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

    def eliminate(self, columns: FloatArray, k: int) -> None:
        """A step of the block Cholesky factorisation, in place.

        columns: (K, (1 + band) n, n), contiguous, block columns from the diagonal down. In column k
        the diagonal block becomes L^-1, of its Cholesky factor L, and the panel P below it P L^-T.
        Of the columns after it the lower triangle loses the square of that panel. Raises
        numpy.linalg.LinAlgError if the block is not positive definite.
        """
        n = columns.shape[2]
        band = columns.shape[1] // n - 1
        step, block = columns.strides[0], columns.strides[1] * n
        diagonal = columns.ctypes.data + k * step
        panel = diagonal + block
        if self._potrf(Blas.COLUMNS, b"U", n, diagonal, n) != 0:
            raise np.linalg.LinAlgError("the matrix is not positive definite")
        divided = (Blas.ROWS, Blas.RIGHT, Blas.LOWER, Blas.TRANSPOSED, Blas.NON_UNIT)
        self._trsm(*divided, band * n, n, 1.0, diagonal, n, panel, n)
        self._trtri(Blas.COLUMNS, b"U", b"N", n, diagonal, n)
        columns[k, :n] *= np.tri(n)
        square, product = (Blas.LOWER, Blas.PLAIN), (Blas.PLAIN, Blas.TRANSPOSED)
        for j in range(band):
            row, rest = panel + j * block, (band - 1 - j) * n
            to = diagonal + (1 + j) * step
            self._syrk(Blas.ROWS, *square, n, n, -1.0, row, n, 1.0, to, n)
            self._gemm(
                *(Blas.ROWS, *product, rest, n, n, -1.0), row + block, n, row, n, 1.0, to + block, n
            )


def _layout(matrix: FloatArray) -> tuple[Blas, int, int]:
    """By rows or columns, address, and how many numbers one lies from the next."""
    size, (rows, columns), (down, right) = matrix.itemsize, matrix.shape, matrix.strides
    if right == size:
        return Blas.PLAIN, matrix.ctypes.data, max(down // size, columns)
    if down == size:
        return Blas.TRANSPOSED, matrix.ctypes.data, max(right // size, rows)
    raise ValueError("neither rows nor columns are contiguous")


def bundled() -> OpenBlas | None:
    """That of CasADi; None where CasADi was built without, or with another than we know."""
    files = (Path(ca.__file__).with_name(name) for name in FILES)
    file = next((file for file in files if file.is_file()), None)
    if file is None:
        return None
    try:
        return OpenBlas(file)
    except (OSError, AttributeError):  # does not load, or lacks a function: numpy is only slower
        return None


@cache
def openblas() -> OpenBlas | None:
    """That of CasADi, None where numpy has a tuned one itself."""
    config = import_module("numpy.__config__")
    told = getattr(config, "CONFIG", {}).get("Build Dependencies", {}).get("blas", {}).get("name")
    older = [value for name, value in vars(config).items() if name.endswith("opt_info")]  # < 1.26
    return None if any(each in f"{told} {older}".lower() for each in TUNED) else bundled()


def product(a: FloatArray, b: FloatArray) -> FloatArray:
    """a @ b of matrices whose rows or columns are contiguous."""
    blas = openblas()
    return np.asarray(a @ b) if blas is None else blas.product(a, b)
