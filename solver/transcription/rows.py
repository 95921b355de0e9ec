"""Equations and bounds as arrays, and the layout of the unknowns that they act on."""

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from ..arrays import BoolArray, FloatArray, IntArray
from ..data.row_kinds import RowKind


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
