"""Seam of splines that repeat: what a motion's last instant has in common with its first.

Values and derivatives at both ends are linear in the first and last coefficients, so these rows are
constant: they hold exactly at every step of a solve (tied_factor.py), at no cost in bandwidth.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import BoolArray, FloatArray
from .block_banded import BlockBanded
from .splines import ORDER, SplineBasis
from .tied_factor import TiedFactor

TIME = 0.05  # s, which makes speeds and accelerations comparable with places


@dataclass(frozen=True)
class Seam:
    """Rows C x = 0, values at the end less values at the start.

    first, last: (R, 4, n) by the blocks of the first and of the last span.
    """

    first: FloatArray
    last: FloatArray

    @staticmethod
    def of(
        basis: SplineBasis, active: BoolArray, smooth: Sequence[FloatArray], sampled: range
    ) -> "Seam":
        """active: (K, n), which unknowns exist. smooth: by order of the derivative, (k, n) the sums
        of splines that are the same at both ends. sampled: columns of piecewise linear functions
        that are; a span's two values are in the middle two of its four blocks."""
        ends = basis.breaks[[0, -1]], np.array([0, basis.n_spans - 1])
        rows = []
        for order, sums in enumerate(smooth):
            weights = TIME**order * basis.evaluate(ends[0], order, ends[1])  # (2, 4)
            rows.append(weights[:, None, :, None] * sums[:, None])
        made = np.zeros((2, len(sampled), ORDER, active.shape[1]))
        for side, block in enumerate((1, ORDER - 2)):
            made[side, np.arange(len(sampled)), block, sampled] = 1.0
        first, last = np.concatenate([*rows, made], axis=1)
        first, last = first * active[:ORDER], last * active[-ORDER:]
        some = (np.abs(first) + np.abs(last)).sum(axis=(1, 2)) > 0.0
        return Seam(first[some], last[some])

    def off(self, x: FloatArray) -> FloatArray:
        """(R,) values C x at unknowns x (K, n)."""
        ends = np.einsum("rkn,kn->r", self.last, x[-ORDER:])
        return np.asarray(ends - np.einsum("rkn,kn->r", self.first, x[:ORDER]))

    def columns(self, blocks: int) -> FloatArray:
        """C' as (K, n, R) of K blocks."""
        columns = np.zeros((blocks, self.first.shape[2], len(self.first)))
        columns[-ORDER:] += np.moveaxis(self.last, 0, 2)
        columns[:ORDER] -= np.moveaxis(self.first, 0, 2)
        return columns

    def closed(self, x: FloatArray, metric: BlockBanded) -> FloatArray:
        """The unknowns (K, n) nearest to x by a metric that meet at the seam."""
        factor = TiedFactor.of(metric.factor(), self.columns(len(x)))
        return np.asarray(x + factor.closing(self.off(x)))
