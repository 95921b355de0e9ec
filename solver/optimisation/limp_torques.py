"""Limp joints' torques have a target: what keeps the small program of a step small.

A limp limb bounds its torques to 0.2 N·m at hundreds of instants. As bounds alone nearly all of
them are violated by a step of least change, so that all enter the dense program of bounded_qp.py,
at one side or the other. With a price on the way to the middle of bounds that are so narrow,

    ... + 1/2 s |b + B_x d - middle|^2,

which the banded factor takes in as it does the equalities, most rows end between their bounds, and
the program is left with the few that do not. So it is where a motion is sought in which all rows
hold; where an objective's minimum is, the price is on any change, for it shall stay there.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import FloatArray, IntArray
from ..data.row_kinds import RowKind
from ..numerics.block_banded import BlockBanded
from ..transcription.rows import Rows
from .span_rows import SpanRows

NARROW = 0.5  # N·m between bounds of a torque: those of limp joints have 0.4
# A thousandth of an equality's: with a tenth of that programs are larger; with three times it and
# more what the rows cannot do, as a spline is no free swing, is paid for with joints' ranges.
PRICE = 20.0


@dataclass(frozen=True)
class LimpTorques:
    """rows: (m,) indices of the torques with narrow bounds. middle: (m,) of the bounds."""

    rows: IntArray
    middle: FloatArray
    jacobian: SpanRows

    @staticmethod
    def of(rows: Rows, weight: float, first: IntArray, basis: FloatArray | None) -> "LimpTorques":
        """weight: the body's, N. first: (S,) first block of each span. basis: see
        LinearisedProblem."""
        torques = (rows.kind == RowKind.TORQUE) & ~rows.equal
        chosen = np.flatnonzero(torques & (weight * (rows.upper - rows.lower) < NARROW))
        middle = 0.5 * (rows.lower + rows.upper)[chosen]
        jacobian = SpanRows.of(rows, chosen, np.ones(len(chosen)), first, basis)
        return LimpTorques(chosen, middle, jacobian)

    def add_normal(self, system: BlockBanded) -> None:
        """Adds s B_x'B_x."""
        if len(self.rows):
            self.jacobian.add_normal(system, PRICE)

    @cached_property
    def none(self) -> FloatArray:
        """`off` of rows that are to stay where they are."""
        return np.zeros(self.jacobian.J.shape[:2])

    def off(self, value: FloatArray) -> FloatArray:
        """By how much all rows' values (R,) are off the middle of narrow bounds, span by span."""
        off = self.none.copy()
        off[self.jacobian.where] = value[self.rows] - self.middle
        return off

    def gradient(self, off: FloatArray, d: FloatArray) -> FloatArray:
        """(K, n) gradient of the price at a change d (K, n) from where the rows are off."""
        if not len(self.rows):
            return np.zeros_like(d)
        return self.jacobian.transposed(PRICE * (off + self.jacobian.times(d)), len(d))
