"""Equations as arrays, and the layout of the unknowns that they act on."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from .recording import FloatArray, IntArray


class RowKind(Enum):
    """What an equation states. The value is the unit of its violation."""

    BALANCE = "BW"
    MOMENT = "BW·m"
    PIN = "m"
    PIN_SPEED = "m/s"
    RELEASE = "BW released"  # a force that would pull is held at zero


@dataclass(frozen=True)
class Layout:
    """Where each unknown sits in the array x (K, n_block): centre of mass, angles, forces.

    The forces of force node g sit in block g + 1; those of blocks 0 and K - 1 do not exist.
    """

    n_angles: int
    n_points: int

    @property
    def n_block(self) -> int:
        return 3 + self.n_angles + 3 * self.n_points

    @property
    def com(self) -> slice:
        return slice(0, 3)

    @property
    def angles(self) -> slice:
        return slice(3, 3 + self.n_angles)

    @property
    def motion(self) -> slice:
        return slice(0, 3 + self.n_angles)

    @property
    def forces(self) -> slice:
        return slice(3 + self.n_angles, self.n_block)

    def force(self, point: int) -> slice:
        first = 3 + self.n_angles + 3 * point
        return slice(first, first + 3)


@dataclass(frozen=True)
class Rows:
    """R equations, each within one span: residual (R,), Jacobian (R, 4, n_block) over the span's
    four blocks, and per row its kind, instant (s) and contact (index or -1)."""

    span: IntArray
    residual: FloatArray
    jacobian: FloatArray
    kind: NDArray[np.object_]
    time: FloatArray
    contact: IntArray

    @staticmethod
    def join(parts: Sequence["Rows"]) -> "Rows":
        names = ("span", "residual", "jacobian", "kind", "time", "contact")
        return Rows(*[np.concatenate([getattr(p, name) for p in parts]) for name in names])

    @staticmethod
    def triples(
        spans: IntArray,
        residual: FloatArray,
        jacobian: FloatArray,
        kind: RowKind,
        times: FloatArray,
        contact: IntArray | None = None,
    ) -> "Rows":
        """Rows of M vector equations: residual (M, 3), Jacobian (M, 3, 4, n_block)."""
        count = 3 * len(spans)
        owner = np.full(len(spans), -1) if contact is None else contact
        return Rows(
            np.repeat(spans, 3),
            residual.ravel(),
            jacobian.reshape(count, *jacobian.shape[2:]),
            np.full(count, kind),
            np.repeat(times, 3),
            np.repeat(owner, 3),
        )
