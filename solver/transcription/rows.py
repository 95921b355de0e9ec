"""Equations and bounds as arrays, and the layout of the unknowns that they act on."""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from ..arrays import BoolArray, FloatArray, IntArray


class RowKind(Enum):
    """What a row states: a name, the unit of its value, and the violation that is let stand."""

    BALANCE = ("balance", "BW", 1e-5)
    MOMENT = ("moment", "BW·m", 2e-5)
    PIN = ("pin", "m", 1e-5)
    PIN_SPEED = ("pin's speed", "m/s", 1e-3)
    POINT = ("point", "m", 3e-4)
    BEND = ("bend", "rad", 2e-3)
    CONE = ("cone", "rad", 2e-3)
    TWIST = ("twist", "rad", 2e-3)
    ORIENTATION = ("orientation", "rad", 2e-3)
    POSE = ("pose", "rad", 2e-3)
    PUSH = ("push", "BW of pull", 0.01)
    FRICTION = ("friction", "BW beyond friction", 0.01)
    PEAK = ("peak", "BW beyond the cap", 0.01)
    TORQUE = ("torque", "BW·m beyond the limit", 2e-5)

    @property
    def unit(self) -> str:
        return self.value[1]

    @property
    def tolerance(self) -> float:
        return self.value[2]


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
    """R rows, each within one span: value (R,) and its Jacobian (R, 4, n_block) over the span's
    four blocks, between lower and upper (R,); an equation where they are equal. Per row its kind,
    instant (s) and owner (the index of a contact, or of a condition counted on from those; -1)."""

    span: IntArray
    value: FloatArray
    jacobian: FloatArray
    lower: FloatArray
    upper: FloatArray
    kind: NDArray[np.object_]
    time: FloatArray
    owner: IntArray

    @staticmethod
    def join(parts: Sequence["Rows"]) -> "Rows":
        names = [field.name for field in fields(Rows)]
        return Rows(*[np.concatenate([getattr(p, name) for p in parts]) for name in names])

    @staticmethod
    def of(
        spans: IntArray,
        value: FloatArray,
        jacobian: FloatArray,
        kind: RowKind,
        times: FloatArray,
        owner: IntArray | int = -1,
        bounds: tuple[FloatArray, FloatArray] | None = None,
    ) -> "Rows":
        """Rows of M vectors: value (M, m), Jacobian (M, m, 4, n_block), bounds each (M, m)."""
        each = value.shape[1]
        count = value.size
        lower, upper = (np.zeros(count),) * 2 if bounds is None else (b.ravel() for b in bounds)
        return Rows(
            np.repeat(spans, each),
            value.ravel(),
            jacobian.reshape(count, *jacobian.shape[2:]),
            lower,
            upper,
            np.full(count, kind),
            np.repeat(times, each),
            np.repeat(np.broadcast_to(owner, len(spans)), each),
        )

    def some(self, which: BoolArray | IntArray) -> "Rows":
        """Those that are chosen, by (R,) flags or by indices."""
        return Rows(*[getattr(self, field.name)[which] for field in fields(Rows)])

    @property
    def equal(self) -> BoolArray:
        """(R,) which rows are equations."""
        return np.asarray(self.lower == self.upper)

    @property
    def tolerance(self) -> FloatArray:
        """(R,) the violation of each that is let stand."""
        return by_kind(self.kind, {kind: kind.tolerance for kind in RowKind})

    def violation(self, value: FloatArray | None = None) -> FloatArray:
        """(R,) by how much values (their own by default) miss the bounds; signed."""
        return violation(self.value if value is None else value, self.lower, self.upper)


def violation(value: FloatArray, lower: FloatArray, upper: FloatArray) -> FloatArray:
    """By how much values miss their bounds: above zero over the upper, below under the lower."""
    return np.asarray(np.maximum(value - upper, 0.0) + np.minimum(value - lower, 0.0))


def by_kind(kinds: NDArray[np.object_], sizes: dict[RowKind, float]) -> FloatArray:
    """(R,) the size of each row's kind; 1 where none is given."""
    values = np.ones(len(kinds))
    for kind, size in sizes.items():
        values[kinds == kind] = size
    return values
