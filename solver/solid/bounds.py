"""What a body is far from, by boxes alone: of a thousand tiles of a floor it is near a few.

A box about a body's joints at each instant against one about each object: as these are far larger
than what is looked at within them, nothing that is near is left out.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..scene.object_motion import ObjectMotion
from ..scene.triangle_mesh import TriangleMesh
from .shapes import Capsules

ROUNDING = 1e-6  # m; numbers of a scene of kilometres are off by less


@dataclass(frozen=True)
class ObjectBounds:
    """A box from low to high (3,) m in the axes of an object, and how it moves. reach: m, from a
    body's joints, of what is kept out of it."""

    motion: ObjectMotion
    low: FloatArray
    high: FloatArray
    reach: float

    @staticmethod
    def of(mesh: TriangleMesh, motion: ObjectMotion, shapes: Capsules) -> "ObjectBounds":
        """Of a mesh, from which shapes are kept out.

        In whichever axes: a capsule's box there is in the ball through that box's corners.
        """
        half = 0.5 * np.linalg.norm(shapes.end - shapes.start, axis=1)
        middle = np.linalg.norm(0.5 * (shapes.start + shapes.end), axis=1)
        furthest = float((middle + half + np.sqrt(3.0) * shapes.radius).max(initial=0.0))
        return ObjectBounds(motion, mesh.low, mesh.high, furthest + ROUNDING)

    def at(self, times: FloatArray) -> FloatArray:
        """(2, N, 3) m, world: within what joints must be to be near, at instants (N,) s."""
        places, turns = self.motion.at(times)
        middle = places + turns @ (0.5 * (self.low + self.high))
        half = np.abs(turns) @ (0.5 * (self.high - self.low)) + self.reach
        return np.stack([middle - half, middle + half])


@dataclass(frozen=True)
class ManyBounds:
    """Those of K objects."""

    each: Sequence[ObjectBounds]

    def met(self, times: FloatArray, joints: FloatArray) -> BoolArray:
        """(K, N) which of them are near at instants (N,) s, at which joints are within boxes (2, N,
        3) m, world. What stands still is compared at once."""
        near = np.empty((len(self.each), len(times)), dtype=bool)
        near[~self._moves] = _meet(self._boxes, joints[:, None])
        for k in np.flatnonzero(self._moves).tolist():
            near[k] = _meet(self.each[k].at(times), joints)
        return near

    @cached_property
    def _moves(self) -> BoolArray:
        return np.array([bounds.motion.thing.moves for bounds in self.each], dtype=bool)

    @cached_property
    def _boxes(self) -> FloatArray:
        """(2, S, 1, 3) m, of what stands still."""
        still = np.flatnonzero(~self._moves).tolist()
        boxes = np.array([self.each[k].at(np.zeros(1)) for k in still])
        return np.moveaxis(boxes.reshape(-1, 2, 1, 3), 1, 0)


def _meet(one: FloatArray, other: FloatArray) -> BoolArray:
    """Whether boxes (2, ..., 3) meet; axis by axis, as there are so many."""
    meet = np.ones(np.broadcast_shapes(one.shape, other.shape)[1:-1], dtype=bool)
    for k in range(3):
        meet &= (one[0, ..., k] <= other[1, ..., k]) & (one[1, ..., k] >= other[0, ..., k])
    return meet
