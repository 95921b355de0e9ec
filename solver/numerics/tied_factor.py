"""Banded systems whose unknowns are tied across the band: min 1/2 x'Ax - b'x subject to C x = 0.

A motion that repeats ties its last instant to its first, which no band holds. But with A = L L' and
Q an orthonormal basis of L^-1 C', the minimiser is L^-T (1 - Q Q') L^-1 b (the null-space form of
the bordered system; Nocedal & Wright 16.2): one more product beside the banded substitutions, after
which the ties hold exactly.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ..arrays import FloatArray
from .block_banded import CholeskyFactor, LocalColumns


class Factor(Protocol):
    """Square root of the inverse of a positive (semi)definite matrix: backward(forward(b))."""

    @property
    def shape(self) -> tuple[int, int]:
        """K blocks of n unknowns."""

    def solve(self, b: FloatArray) -> FloatArray:
        """Minimiser x of 1/2 x'Ax - b'x, both (K, n) or (K, n, m)."""

    def forward(self, b: FloatArray) -> FloatArray:
        """First half of `solve`."""

    def forward_locally(self, b: LocalColumns) -> LocalColumns:
        """First half of `solve`, without what is negligible."""

    def backward(self, b: FloatArray) -> FloatArray:
        """Second half of `solve`."""


@dataclass(frozen=True)
class TiedFactor:
    """Factor of A on the x with C x = 0. across: (K, n, R), Q; triangle: (R, R) with L^-1 C' = Q
    triangle."""

    banded: CholeskyFactor
    across: FloatArray
    triangle: FloatArray

    @staticmethod
    def of(banded: CholeskyFactor, columns: FloatArray) -> "TiedFactor":
        """columns: C' (K, n, R), independent."""
        half = banded.forward(columns)
        across, triangle = np.linalg.qr(half.reshape(-1, half.shape[2]))
        return TiedFactor(banded, across.reshape(half.shape), triangle)

    @property
    def shape(self) -> tuple[int, int]:
        return self.banded.shape

    def solve(self, b: FloatArray) -> FloatArray:
        """Minimiser of 1/2 x'Ax - b'x with C x = 0; b, x (K, n) or (K, n, m)."""
        return self.backward(self.forward(b))

    def forward(self, b: FloatArray) -> FloatArray:
        """(1 - Q Q') L^-1 b."""
        half = self.banded.forward(b)
        share = np.einsum("knr,kn...->r...", self.across, half, optimize=True)
        return np.asarray(half - np.einsum("knr,r...->kn...", self.across, share, optimize=True))

    def forward_locally(self, b: LocalColumns) -> LocalColumns:
        """Likewise; the ties reach everywhere."""
        whole = np.zeros((*self.shape, b.values.shape[2]))
        whole[b.first : b.first + len(b.values)] = b.values
        return LocalColumns(0, self.forward(whole))

    def backward(self, b: FloatArray) -> FloatArray:
        """L^-T b."""
        return self.banded.backward(b)

    def closing(self, off: FloatArray) -> FloatArray:
        """The change x (K, n) of least x'Ax that makes C x = -off, (R,)."""
        share = np.linalg.solve(self.triangle.T, off)
        return self.banded.backward(-np.einsum("knr,r->kn", self.across, share))
