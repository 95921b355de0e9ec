"""Contact forces push and stay in their friction cones (thesis 3.3, 4.2).

The bounds hold at the force nodes; forces are linear between these and the sets are convex, so
they hold at every instant. The round cone is used as it is, |f_t| <= mu f_n; the pyramid has the
four planes |f_1| + |f_2| <= mu f_n inside it.
"""

from collections.abc import Sequence

import numpy as np

from ..arrays import FloatArray
from ..data.row_kinds import RowKind
from ..numerics.rotations import perpendicular, unit
from ..numerics.splines import ORDER, SplineBasis
from .contact_pins import PointContact
from .rows import Layout, Rows

LEAST = 1e-9  # BW; below it a tangential force has no direction


class ForceCones:
    """Push and friction rows of contacts on one basis, at U pairs of a force node and a contact."""

    def __init__(
        self, basis: SplineBasis, layout: Layout, contacts: Sequence[PointContact]
    ) -> None:
        self._layout = layout
        nodes, owner = [], []
        middles = 0.5 * (basis.breaks[:-1] + basis.breaks[1:])
        for i, contact in enumerate(contacts):
            if contact.friction is None:
                continue
            span = contact.contact
            touching = np.flatnonzero((middles > span.start) & (middles < span.end))
            mine = np.unique(basis.force_nodes(touching))
            nodes.append(mine)
            owner.append(np.full(len(mine), i))
        self._owner = np.concatenate(owner) if owner else np.zeros(0, int)
        self._blocks = (np.concatenate(nodes) if nodes else np.zeros(0, int)) + 1
        last = basis.first_coefficient + 1  # the block of each span's first force node
        after = np.searchsorted(last, self._blocks, side="right") - 1
        self._spans = np.clip(after, 0, basis.n_spans - 1)
        self._local = self._blocks - basis.first_coefficient[self._spans]
        side = self._local - 1
        self._times = basis.breaks[self._spans + side]
        self._point = np.array([contacts[i].point for i in self._owner], dtype=int)
        self._mu = np.array([contacts[i].friction for i in self._owner], dtype=float)
        self._frames = np.array([_frame(contacts[i].normal) for i in self._owner]).reshape(-1, 3, 3)
        self._pyramid = np.array([contacts[i].pyramid for i in self._owner], dtype=bool)

    def forces(self, x: FloatArray) -> FloatArray:
        """(U, 3) forces in body weights along two tangents and the normal."""
        columns = self._layout.forces.start + 3 * self._point[:, None] + np.arange(3)
        world = x[self._blocks[:, None], columns]
        return np.asarray(np.einsum("uij,uj->ui", self._frames, world))

    def values(self, x: FloatArray) -> FloatArray:
        """The values of `rows`, in their order."""
        forces = self.forces(x)
        return np.concatenate([forces[:, 2], self._friction(forces)[0].ravel()])

    def rows(self, x: FloatArray) -> list[Rows]:
        """Rows of pushing, then of friction."""
        forces = self.forces(x)
        value, slope = self._friction(forces)
        push = np.tile([0.0, 0.0, 1.0], (len(forces), 1, 1))
        zero, none = np.zeros(forces[:, 2:].shape), np.full(value.shape, -np.inf)
        return [
            self._rows(forces[:, 2:], push, RowKind.PUSH, (zero, zero + np.inf)),
            self._rows(value, slope, RowKind.FRICTION, (none, np.zeros(value.shape))),
        ]

    def _friction(self, forces: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Excess (U, m) over the cone and its derivative (U, m, 3); m is 1, or 4 with pyramids."""
        tangential = np.linalg.norm(forces[:, :2], axis=1)
        value = (tangential - self._mu * forces[:, 2])[:, None]
        slope = np.zeros((len(forces), 1, 3))
        slope[:, 0, :2] = forces[:, :2] / np.maximum(tangential, LEAST)[:, None]
        slope[:, 0, 2] = -self._mu
        if not self._pyramid.any():
            return value, slope
        signs = np.array([[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]])
        planes = np.zeros((len(forces), 4, 3))
        planes[:, :, :2] = signs
        planes[:, :, 2] = -self._mu[:, None]
        flat = np.einsum("umi,ui->um", planes, forces)
        which = self._pyramid[:, None]
        return np.where(which, flat, value), np.where(which[..., None], planes, slope)

    def _rows(
        self,
        value: FloatArray,
        slope: FloatArray,
        kind: RowKind,
        bounds: tuple[FloatArray, FloatArray],
    ) -> Rows:
        count, each = value.shape
        jacobian = np.zeros((count, each, ORDER, self._layout.n_block))
        world = slope @ self._frames
        at = np.arange(count)
        for axis in range(3):
            column = self._layout.forces.start + 3 * self._point + axis
            jacobian[at, :, self._local, column] = world[..., axis]
        return Rows.of(self._spans, value, jacobian, kind, self._times, self._owner, bounds)


def _frame(normal: FloatArray) -> FloatArray:
    """(3, 3) rows two tangents and the normal."""
    up = normal / np.linalg.norm(normal)
    ahead = np.array([1.0, 0.0, 0.0])
    first = unit(ahead - up[0] * up) if abs(up[2]) > 0.999 else perpendicular(up)
    return np.stack([first, np.cross(up, first), up])
