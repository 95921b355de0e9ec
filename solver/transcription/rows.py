"""Constraint rows as arrays, and the layout of the unknowns that they act on."""

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from ..arrays import BoolArray, FloatArray, IntArray
from ..data.row_kinds import RowKind

FORCE_BLOCKS = slice(1, 3)  # of the four blocks of a span: those that hold its two force values
ROOT_ANGLES = 3


@dataclass(frozen=True)
class Layout:
    """Layout of the unknowns x (K, n_block): block k holds coefficients k of the splines of centre
    of mass (m, world) and joint angles (rad, the root's first), then forces (body weights, world).

    Force node g sits in block g + 1; blocks 0 and K - 1 have no forces.
    """

    n_angles: int
    n_points: int

    @property
    def n_motion(self) -> int:
        return 3 + self.n_angles

    @property
    def n_block(self) -> int:
        return self.n_motion + 3 * self.n_points

    @property
    def com(self) -> slice:
        return slice(0, 3)

    @property
    def angles(self) -> slice:
        return slice(3, self.n_motion)

    @property
    def root_angles(self) -> slice:
        return slice(3, 3 + ROOT_ANGLES)

    @property
    def joint_angles(self) -> slice:
        """Every joint's but the root's."""
        return slice(3 + ROOT_ANGLES, self.n_motion)

    @property
    def motion(self) -> slice:
        """Centre of mass and angles."""
        return slice(0, self.n_motion)

    @property
    def forces(self) -> slice:
        return slice(self.n_motion, self.n_block)

    @property
    def vertical_forces(self) -> slice:
        return slice(self.n_motion + 2, self.n_block, 3)

    def force(self, point: int) -> slice:
        """The three components at a touching point."""
        first = self.n_motion + 3 * point
        return slice(first, first + 3)

    def vertical_force(self, point: int) -> int:
        return self.n_motion + 3 * point + 2

    def force_columns(self, points: IntArray) -> IntArray:
        """(U, 3) columns of the components at touching points (U,)."""
        return np.asarray(self.n_motion + 3 * points[:, None] + np.arange(3))

    @staticmethod
    def force_block(nodes: IntArray) -> IntArray:
        """Blocks that hold the values at force nodes."""
        return nodes + FORCE_BLOCKS.start


@dataclass(frozen=True)
class Rows:
    """R constraint rows lower <= value <= upper, (R,) each, an equality where the bounds are equal.

    span: the span that a row depends on; jacobian: (R, 4, n_block) by that span's four blocks.
    time: s. owner: the index of a contact, or of a constraint counted on from those, else -1.
    slack: what counts as met beyond the kind's tolerance, in its unit.
    """

    span: IntArray
    value: FloatArray
    jacobian: FloatArray
    lower: FloatArray
    upper: FloatArray
    kind: NDArray[np.object_]
    time: FloatArray
    owner: IntArray
    slack: FloatArray

    @staticmethod
    def join(parts: Sequence["Rows"]) -> "Rows":
        """Concatenation in the given order."""
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
        slack: FloatArray | float = 0.0,
    ) -> "Rows":
        """Rows of M vectors: value (M, m), Jacobian (M, m, 4, n_block), bounds each (M, m), owner
        and slack (M,) or one."""
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
            np.repeat(np.broadcast_to(slack, len(spans)), each),
        )

    def some(self, which: BoolArray | IntArray | slice) -> "Rows":
        """Subset by (R,) flags, by indices, or by a slice, which is no copy."""
        return Rows(*[getattr(self, field.name)[which] for field in fields(Rows)])

    @property
    def equal(self) -> BoolArray:
        """(R,) equality flags."""
        return np.asarray(self.lower == self.upper)

    @property
    def guards(self) -> BoolArray:
        """(R,) flags of the guard rows."""
        return np.asarray(by_kind(self.kind, {kind: 0.0 for kind in RowKind if kind.guards}) == 0.0)

    @property
    def unguarded(self) -> "Rows":
        """Those without the guard rows, which must be the last."""
        return self.some(slice(len(self.value) - int(self.guards.sum())))

    @property
    def tolerance(self) -> FloatArray:
        """(R,) feasibility tolerance of each, in its kind's unit."""
        return by_kind(self.kind, {kind: kind.tolerance for kind in RowKind}) + self.slack

    def violation(self, value: FloatArray | None = None) -> FloatArray:
        """(R,) signed violation of the bounds by values (R,), the rows' own by default."""
        return violation(self.value if value is None else value, self.lower, self.upper)


def inside(spans: IntArray, part: slice) -> BoolArray:
    """Flags of the spans (R,) that are in a part of all."""
    return np.asarray((spans >= part.start) & (spans < part.stop))


def violation(value: FloatArray, lower: FloatArray, upper: FloatArray) -> FloatArray:
    """Signed bound violation: positive over the upper, negative under the lower, else zero."""
    return np.asarray(np.maximum(value - upper, 0.0) + np.minimum(value - lower, 0.0))


def by_kind(kinds: NDArray[np.object_], sizes: dict[RowKind, float]) -> FloatArray:
    """(R,) each row's entry of a table by kind; 1 where it has none."""
    values = np.ones(len(kinds))
    for kind, size in sizes.items():
        values[kinds == kind] = size
    return values
