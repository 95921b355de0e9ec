"""The way out of an object along one direction, wherever a shape is in front of one of its faces.

The way out of a mesh is the nearest, which for a thin hurdle is forwards before its middle and
backwards behind: no movement goes both ways. Along one way, such as up, the object reaches as far
as its furthest face there, and what is beyond is out, from the first instant to the last.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..data.constants import UP
from ..data.requests import Vector
from ..numerics.rotations import unit
from ..scene.object_motion import ObjectMotion
from .profile import Profile, profile_under_balls
from .shapes import Capsules
from .surfaces import WORLD, Closest, Placed, axes_in

BESIDE = 1.0  # m, in place of the distance of what is not in front of the object
SAMPLING = 0.02  # m along an axis, between the points from which its lowest is sought


@dataclass(frozen=True)
class WayOut:
    """way: a unit vector in the object's axes. by: (C,) m, how far beyond it the shapes stay.

    sought: whether shapes that are not as far are found at all instants; else by others alone.
    """

    motion: ObjectMotion
    way: Vector
    shapes: Capsules
    by: FloatArray
    names: tuple[str, ...]
    sought: bool = True
    bounds: ClassVar[None] = None

    @staticmethod
    def above(
        motion: ObjectMotion, shapes: Capsules, by: FloatArray, names: tuple[str, ...]
    ) -> "WayOut":
        """Up, as the object stands at first: its clearance."""
        return WayOut(motion, as_way(motion.thing.rotations[0].T @ UP), shapes, by, names)

    def near(self, placed: Placed) -> tuple[IntArray, IntArray]:
        """Exactly those that are too low, if they are sought."""
        none = np.empty(0, dtype=int)
        return self.beneath(placed) if self.sought else (none, none)

    def beneath(self, placed: Placed) -> tuple[IntArray, IntArray]:
        """Exactly those that are too low."""
        instants, items = np.indices((len(placed.times), len(self.names))).reshape(2, -1)
        low = self._lowest(placed, instants, items)[0] < 0.0
        return instants[low], items[low]

    def closest(self, placed: Placed, instants: IntArray, items: IntArray) -> Closest:
        """How far beyond the object, less what is asked for, the shapes' lowest points are."""
        distance, share, over = self._lowest(placed, instants, items)
        start, end = self.shapes.some_ends(placed.pose, instants, items)
        at = start + share[:, None] * (end - start)
        _, turns = self.motion.at(placed.times)
        normal = over[:, None] * (turns[instants] @ np.array(self.way))
        both = np.stack([self.shapes.bodies[items], np.full(len(items), WORLD)], axis=1)
        apart = np.full(len(items), np.inf)
        return Closest(distance, normal, both, np.stack([at, at], axis=1), apart)

    def _lowest(
        self, placed: Placed, instants: IntArray, items: IntArray
    ) -> tuple[FloatArray, FloatArray, BoolArray]:
        """Distances (N,) m, shares (N,) of the axes at the lowest points, and whether in front."""
        start, end = axes_in(self.motion, self.shapes, placed, instants, items)
        distance, share = np.full(len(items), np.inf), np.zeros(len(items))
        for item in np.unique(items).tolist():
            mine, radius = np.flatnonzero(items == item), float(self.shapes.radius[item])
            profile = profile_under_balls(self.motion.thing, self.way, radius)
            distance[mine], share[mine] = _lowest(profile, start[mine], end[mine])
        over = np.isfinite(distance)
        return np.where(over, distance - self.by[items], BESIDE), share, over


def as_way(vector: FloatArray) -> Vector:
    """The direction of (3,), rounded, so that the same is found again."""
    x, y, z = np.round(unit(vector), 9).tolist()
    return x, y, z


def _lowest(profile: Profile, start: FloatArray, end: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Least heights (N,) m above a profile along segments from start to end (N, 3) m, in the
    object's axes, and where, as shares; infinite where they are nowhere over it."""
    start, end = start @ profile.axes, end @ profile.axes
    height, share = np.full(len(start), np.inf), np.zeros(len(start))
    ends = np.stack([start, end])[..., :2]
    near = (ends.min(axis=0) <= profile.high) & (ends.max(axis=0) >= profile.low)
    near = np.flatnonzero(near.all(axis=1))
    along = end[near] - start[near]
    longest = float(np.linalg.norm(along, axis=1).max(initial=0.0))
    shares = np.linspace(0.0, 1.0, 2 + int(longest / SAMPLING))
    points = start[near] + shares[:, None, None] * along
    above = points[..., 2] - profile.at(points[..., :2].reshape(-1, 2)).reshape(points.shape[:2])
    least = above.argmin(axis=0)
    height[near], share[near] = above.min(axis=0), shares[least]
    return height, share
