"""Cholesky factorisation of one dense matrix."""

from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from .openblas import openblas


@dataclass(frozen=True)
class DenseCholesky:
    """lower: (n, n), whose lower triangle is L, of L L'."""

    lower: FloatArray

    @staticmethod
    def of(matrix: FloatArray) -> "DenseCholesky":
        """Of a symmetric matrix (n, n), which stays as it is. Raises LinAlgError where it is not
        positive definite."""
        lower = np.array(matrix, dtype=float, order="C")
        if lower.size:  # LAPACK knows no empty ones
            openblas().factor(lower)
        return DenseCholesky(lower)

    def solve(self, right: FloatArray) -> FloatArray:
        """(n,) solution for a right side (n,)."""
        x = np.array(right, dtype=float)
        if x.size:
            openblas().solve(self.lower, x)
        return x

    def inverse(self) -> FloatArray:
        """(n, n) of the matrix."""
        inverse = self.lower.copy()
        if inverse.size:
            openblas().invert(inverse)
        above = np.triu_indices(len(inverse), 1)
        inverse[above] = inverse.T[above]
        return inverse
