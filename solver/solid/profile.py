"""How far an object reaches along a way, such as up: its profile as a raster, and what balls find.

A ball stays above a mesh when its centre stays above the mesh's profile dilated by the ball (grey
dilation with a ball as structuring element: Sternberg, Grayscale morphology, 1986).
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..arrays import FloatArray
from ..data.requests import Vector
from ..data.scene import SceneObject

FINEST = 0.01  # m, between nodes
MOST_NODES = 128  # along an axis
DENSITY = 2  # points on a triangle for each node along its longest side
TOGETHER = 1_000_000  # points at once
REMEMBERED = 2048  # of an object some ten radii along fourteen ways; a character is fifteen


@dataclass(frozen=True)
class Profile:
    """Heights (X, Y) m along a way at nodes low (2,) + i cell (2,) m across it; -inf where there is
    nothing. axes: (3, 3), columns across and along the way in the object's axes."""

    axes: FloatArray
    low: FloatArray
    cell: FloatArray
    height: FloatArray

    @property
    def high(self) -> FloatArray:
        """(2,) m, of its last node."""
        return np.asarray(self.low + self.cell * (np.array(self.height.shape) - 1))

    def at(self, places: FloatArray) -> FloatArray:
        """(N,) m at places (N, 2): linear between nodes, the highest of those there are."""
        last = np.array(self.height.shape) - 1
        x, y = np.moveaxis((places - self.low) / self.cell, -1, 0)
        i, j = np.floor(x).astype(int), np.floor(y).astype(int)
        beside = (x < 0.0) | (y < 0.0) | (x > last[0]) | (y > last[1])
        i, j = np.clip(i, 0, max(last[0] - 1, 0)), np.clip(j, 0, max(last[1] - 1, 0))
        ends = np.minimum(i + 1, last[0]), np.minimum(j + 1, last[1])
        around = np.stack([self.height[a, b] for a in (i, ends[0]) for b in (j, ends[1])])
        u, v = np.clip(x - i, 0.0, 1.0), np.clip(y - j, 0.0, 1.0)
        shares = np.stack([(1 - u) * (1 - v), (1 - u) * v, u * (1 - v), u * v])
        whole = np.isfinite(around).all(axis=0)
        between = (shares * np.where(whole, around, 0.0)).sum(axis=0)
        found = np.where(whole, between, around.max(axis=0))
        return np.asarray(np.where(beside, -np.inf, found))

    def dilated(self, radius: float) -> "Profile":
        """How high the centres of balls, radius m, that touch it are."""
        reach = np.ceil(radius / self.cell).astype(int)
        size = np.array(self.height.shape)
        found = np.full(size + 2 * reach, -np.inf)
        for i in range(-reach[0], reach[0] + 1):
            for j in range(-reach[1], reach[1] + 1):
                rest = radius**2 - (i * self.cell[0]) ** 2 - (j * self.cell[1]) ** 2
                if rest >= 0.0:
                    a, b = reach[0] + i, reach[1] + j
                    part = found[a : a + size[0], b : b + size[1]]
                    np.maximum(part, self.height + np.sqrt(rest), out=part)
        return Profile(self.axes, self.low - reach * self.cell, self.cell, found)


@lru_cache(maxsize=REMEMBERED)
def profile_under_balls(thing: SceneObject, way: Vector, radius: float) -> Profile:
    """Of an object along a unit vector in its own axes, from its origin; remembered."""
    return _profile(thing, way).dilated(radius)


@lru_cache(maxsize=REMEMBERED)
def _profile(thing: SceneObject, way: Vector) -> Profile:
    axes = _across(np.array(way))
    triangles = (thing.vertices @ axes)[thing.triangles]
    low, high = triangles.min(axis=(0, 1))[:2], triangles.max(axis=(0, 1))[:2]
    cell = np.maximum(FINEST, (high - low) / (MOST_NODES - 1))
    height = np.full(np.ceil((high - low) / cell).astype(int) + 1, -np.inf)
    for spread in _spread(triangles, cell):
        i, j = np.round((spread[:, :2] - low) / cell).astype(int).T
        np.maximum.at(height, (i, j), spread[:, 2])
    return Profile(axes, low, cell, height)


def _across(way: FloatArray) -> FloatArray:
    """(3, 3) a right-handed frame whose last column is the way, its first near an own axis."""
    own = np.eye(3)[int(np.argmin(np.abs(way)))]
    first = own - way * (own @ way)
    first /= np.linalg.norm(first)
    return np.stack([first, np.cross(way, first), way], axis=1)


def _spread(triangles: FloatArray, cell: FloatArray) -> Iterator[FloatArray]:
    """Points (N, 3) on triangles (F, 3, 3), no further apart than nodes, corners and edges too."""
    sides = np.abs(np.roll(triangles, 1, axis=1) - triangles)[..., :2] / cell
    parts = np.maximum(1.0, DENSITY * sides.max(axis=(1, 2)))
    level = np.ceil(np.log2(parts)).astype(int)
    for each in np.unique(level):
        n = 1 << int(each)
        a, b = np.indices((n + 1, n + 1)).reshape(2, -1)
        shares = np.stack([a, b, n - a - b], axis=1)[a + b <= n] / n
        mine = triangles[level == each]
        for few in np.array_split(mine, -(-len(mine) * len(shares) // TOGETHER)):
            yield np.einsum("pc,fci->fpi", shares, few).reshape(-1, 3)
