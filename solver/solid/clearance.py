"""Clearance: what is over an object stays so far above it, so that the way goes over it.

The way out of a mesh is the nearest, which for a thin hurdle is forwards before its middle and
backwards behind: no movement goes both ways. Here it is up, wherever a shape is over the object's
base, a rectangle along its own heading; the object counts as high as it is anywhere.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..data.scene import SceneObject
from ..numerics.rotations import axis_rotation
from ..scene.object_motion import ObjectMotion
from .shapes import Capsules
from .surfaces import WORLD, Closest, Placed

BESIDE = 1.0  # m, in place of the distance of what is not over the object
LEVEL = 1e-9  # m, least extent along an axis


@dataclass(frozen=True)
class Clearance:
    """by: (C,) m, of the shapes. low, high: (3,) m, the object's box along its heading."""

    motion: ObjectMotion
    shapes: Capsules
    by: FloatArray
    low: FloatArray
    high: FloatArray
    names: tuple[str, ...]

    @staticmethod
    def over(
        thing: SceneObject,
        motion: ObjectMotion,
        shapes: Capsules,
        by: FloatArray,
        names: tuple[str, ...],
    ) -> "Clearance":
        """Of an object, as it is turned at first."""
        turn = thing.rotations[0]
        points = thing.vertices @ turn.T @ axis_rotation(2, _heading(turn[None])[0])
        return Clearance(motion, shapes, by, points.min(axis=0), points.max(axis=0), names)

    def near(self, placed: Placed) -> tuple[IntArray, IntArray]:
        """Exactly those that are too low."""
        instants, items = np.indices((len(placed.times), len(self.names))).reshape(2, -1)
        low = self._lowest(placed, instants, items)[0] < 0.0
        return instants[low], items[low]

    def closest(self, placed: Placed, instants: IntArray, items: IntArray) -> Closest:
        """Heights above the object, less the clearance, of the lowest points over it."""
        distance, share, over = self._lowest(placed, instants, items)
        start, end = self.shapes.some_ends(placed.pose, instants, items)
        at = start + share[:, None] * (end - start)
        normal = over[:, None] * np.array([0.0, 0.0, 1.0])
        both = np.stack([self.shapes.bodies[items], np.full(len(items), WORLD)], axis=1)
        apart = np.full(len(items), np.inf)
        return Closest(distance, normal, both, np.stack([at, at], axis=1), apart)

    def _lowest(
        self, placed: Placed, instants: IntArray, items: IntArray
    ) -> tuple[FloatArray, FloatArray, BoolArray]:
        """Distances (N,) m, shares (N,) of the axes at the lowest points, and whether over it."""
        places, turns = self.motion.at(placed.times)
        turn = axis_rotation(2, _heading(turns))[instants]
        shift = (placed.com - places)[instants]
        start, end = (
            np.einsum("nji,nj->ni", turn, each + shift)
            for each in self.shapes.some_ends(placed.pose, instants, items)
        )
        along = end - start
        radius = self.shapes.radius[items]
        flat = np.where(np.abs(along[:, :2]) < LEVEL, LEVEL, along[:, :2])
        edges = [
            (side[:2] + way * radius[:, None] - start[:, :2]) / flat
            for side, way in ((self.low, -1.0), (self.high, 1.0))
        ]
        enters = np.maximum(np.minimum(*edges).max(axis=1), 0.0)
        leaves = np.minimum(np.maximum(*edges).min(axis=1), 1.0)
        over = enters <= leaves
        share = np.where(over, np.where(along[:, 2] > 0.0, enters, leaves), 0.0)
        height = start[:, 2] + share * along[:, 2] - radius - self.by[items] - self.high[2]
        return np.where(over, height, BESIDE), share, over


def _heading(turns: FloatArray) -> FloatArray:
    """(N,) rad, about the vertical, of rotations (N, 3, 3)."""
    return np.asarray(np.arctan2(turns[:, 1, 0], turns[:, 0, 0]))
