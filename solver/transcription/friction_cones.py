"""Friction cones: unilateral contact forces with Coulomb friction (thesis 3.3, 4.2).

The bounds hold at the force nodes; forces are linear between these and the sets are convex, so
they hold at every instant. The round cone is |f_t| <= mu f_n; the pyramid has the four planes
|f_1| + |f_2| <= mu f_n inside it. On ground that tilts they turn with it from node to node.
"""

from collections.abc import Sequence
from copy import copy

import numpy as np

from ..arrays import FloatArray
from ..data.row_kinds import RowKind
from ..numerics.rigid_motion import Poses
from ..numerics.rotations import perpendicular, unit
from ..numerics.splines import ORDER, SplineBasis
from .contact_pins import PointContact, touching_spans
from .rows import FORCE_BLOCKS, Layout, Rows, inside

MIN_TANGENTIAL_FORCE = 1e-9  # BW; below it a tangential force has no direction


class FrictionCones:
    """Push and friction rows on one basis, at U pairs of a force node and a contact."""

    def __init__(
        self, basis: SplineBasis, layout: Layout, contacts: Sequence[PointContact]
    ) -> None:
        self._layout = layout
        nodes, owner = [], []
        for i, contact in enumerate(contacts):
            if contact.friction is None:
                continue
            mine = np.unique(basis.force_nodes(touching_spans(basis, contact.contact)))
            nodes.append(mine)
            owner.append(np.full(len(mine), i))
        self._owner = np.concatenate(owner) if owner else np.zeros(0, int)
        self._blocks = layout.force_block(np.concatenate(nodes) if nodes else np.zeros(0, int))
        last = basis.first_coefficient + FORCE_BLOCKS.start  # of each span's first force node
        after = np.searchsorted(last, self._blocks, side="right") - 1
        self._spans = np.clip(after, 0, basis.n_spans - 1)
        self._local = self._blocks - basis.first_coefficient[self._spans]
        side = self._local - FORCE_BLOCKS.start
        self._times = basis.breaks[self._spans + side]
        point = np.array([contacts[i].point for i in self._owner], dtype=int)
        self._columns = layout.force_columns(point)
        self._mu = np.array([contacts[i].friction for i in self._owner], dtype=float)
        self._frames = np.zeros((len(self._owner), 3, 3))
        for i, contact in enumerate(contacts):
            mine = self._owner == i
            turns = Poses.still(int(mine.sum())).turn
            if contact.ride is not None:
                turns = contact.ride.poses(self._times[mine]).turn
            self._frames[mine] = _frame(contact.normal) @ np.swapaxes(turns, 1, 2)
        self._pyramid = np.array([contacts[i].pyramid for i in self._owner], dtype=bool)

    def within(self, spans: slice) -> "FrictionCones":
        """Those in some of the spans."""
        twin, kept = copy(self), inside(self._spans, spans)
        twin._owner, twin._blocks, twin._spans = (
            each[kept] for each in (self._owner, self._blocks, self._spans)
        )
        twin._local, twin._times, twin._columns = (
            each[kept] for each in (self._local, self._times, self._columns)
        )
        twin._mu, twin._frames, twin._pyramid = (
            each[kept] for each in (self._mu, self._frames, self._pyramid)
        )
        return twin

    def forces(self, x: FloatArray) -> FloatArray:
        """(U, 3) forces in body weights along two tangents and the normal; x (K, n_block)."""
        world = x[self._blocks[:, None], self._columns]
        return np.asarray(np.einsum("uij,uj->ui", self._frames, world))

    def values(self, x: FloatArray) -> FloatArray:
        """Values of `rows`, in their order, without the Jacobian."""
        forces = self.forces(x)
        return np.concatenate([forces[:, 2], self._friction(forces)[0].ravel()])

    def rows(self, x: FloatArray) -> list[Rows]:
        """Rows of pushing (f_n >= 0), then of friction; body weights."""
        forces = self.forces(x)
        value, jacobian = self._friction(forces)
        push = np.tile([0.0, 0.0, 1.0], (len(forces), 1, 1))
        zero, none = np.zeros(forces[:, 2:].shape), np.full(value.shape, -np.inf)
        return [
            self._rows(forces[:, 2:], push, RowKind.PUSH, (zero, zero + np.inf)),
            self._rows(value, jacobian, RowKind.FRICTION, (none, np.zeros(value.shape))),
        ]

    def _friction(self, forces: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Excess (U, m) over the cone, and Jacobian (U, m, 3); m is 1, or 4 with pyramids."""
        tangential = np.linalg.norm(forces[:, :2], axis=1)
        value = (tangential - self._mu * forces[:, 2])[:, None]
        jacobian = np.zeros((len(forces), 1, 3))
        jacobian[:, 0, :2] = forces[:, :2] / np.maximum(tangential, MIN_TANGENTIAL_FORCE)[:, None]
        jacobian[:, 0, 2] = -self._mu
        if not self._pyramid.any():
            return value, jacobian
        signs = np.array([[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]])
        planes = np.zeros((len(forces), 4, 3))
        planes[:, :, :2] = signs
        planes[:, :, 2] = -self._mu[:, None]
        flat = np.einsum("umi,ui->um", planes, forces)
        which = self._pyramid[:, None]
        return np.where(which, flat, value), np.where(which[..., None], planes, jacobian)

    def _rows(
        self,
        value: FloatArray,
        by_force: FloatArray,
        kind: RowKind,
        bounds: tuple[FloatArray, FloatArray],
    ) -> Rows:
        count, each = value.shape
        jacobian = np.zeros((count, each, ORDER, self._layout.n_block))
        world = by_force @ self._frames
        at = np.arange(count)
        for axis in range(3):
            jacobian[at, :, self._local, self._columns[:, axis]] = world[..., axis]
        return Rows.of(self._spans, value, jacobian, kind, self._times, self._owner, bounds)


def _frame(normal: FloatArray) -> FloatArray:
    """(3, 3) contact frame, rows two tangents and the normal."""
    up = normal / np.linalg.norm(normal)
    ahead = np.array([1.0, 0.0, 0.0])
    first = unit(ahead - up[0] * up) if abs(up[2]) > 0.999 else perpendicular(up)
    return np.stack([first, np.cross(up, first), up])
