"""A bounding-volume tree over triangles, asked by many points at once.

Built from the order of the centres along a Morton curve (Lauterbach et al. 2009), as a complete
binary tree without pointers; searched level by level, all points together, so that numpy does it. A
few triangles are not searched: numpy looks at all sooner.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from .point_triangle import Triangles

LEAF = 4  # triangles
FEW = 500  # triangles; to look at all of fewer takes no longer than to search a tree
GRID_BITS = 16  # of the Morton curve, an axis
TOGETHER = 4096  # points searched at once
MOST_PAIRS = 100_000  # of a point and a box, looked at at once
NOWHERE = 1e9  # m; a box without triangles lies so far off on all sides
ROUNDING = 1e-12  # of a squared distance


@dataclass(frozen=True)
class TriangleTree:
    """triangles: (F, 3, 3) m corners, in the tree's order; order: (F,) their indices as given.

    low, high: (2 leaves - 1, 3) m boxes; the children of node i are 2 i + 1 and 2 i + 2.
    """

    triangles: FloatArray
    order: IntArray
    low: FloatArray
    high: FloatArray

    @staticmethod
    def of(triangles: FloatArray) -> "TriangleTree":
        """The tree of (F, 3, 3) m corners, at least one triangle."""
        order = np.argsort(_morton(triangles.mean(axis=1)), kind="stable")
        sorted_ = triangles[order]
        leaves = 1 << max(0, int(np.ceil(np.log2(np.ceil(len(order) / LEAF)))))
        low, high = (np.full((2 * leaves - 1, 3), sign * NOWHERE) for sign in (1.0, -1.0))
        first = np.arange(0, len(order), LEAF)
        at = slice(leaves - 1, leaves - 1 + len(first))
        low[at] = np.minimum.reduceat(sorted_.min(axis=1), first)
        high[at] = np.maximum.reduceat(sorted_.max(axis=1), first)
        while leaves > 1:
            below = slice(leaves - 1, 2 * leaves - 1)
            leaves //= 2
            at = slice(leaves - 1, 2 * leaves - 1)
            low[at] = low[below].reshape(-1, 2, 3).min(axis=1)
            high[at] = high[below].reshape(-1, 2, 3).max(axis=1)
        return TriangleTree(sorted_, order, low, high)

    @cached_property
    def _measured(self) -> Triangles:
        return Triangles.of(self.triangles)

    @property
    def _depth(self) -> int:
        return (len(self.low) + 1).bit_length() - 2

    def closest(self, points: FloatArray) -> IntArray:
        """(N,) the triangles nearest to points (N, 3) m, in the tree's order."""
        few = len(self.triangles) <= FEW
        together = MOST_PAIRS // len(self.triangles) if few else TOGETHER
        find = self._closest_of_all if few else self._closest
        parts = np.array_split(points, max(1, -(-len(points) // together)))
        return np.concatenate([find(part) for part in parts])

    def _closest_of_all(self, points: FloatArray) -> IntArray:
        return np.asarray(self._measured.apart(points).argmin(axis=1))

    def _closest(self, points: FloatArray) -> IntArray:
        bound, found = np.full(len(points), np.inf), np.full(len(points), np.inf)
        nearest = np.zeros(len(points), dtype=int)
        waiting = [(0, np.arange(len(points)), np.zeros(len(points), dtype=int))]
        while waiting:
            level, every, node = waiting.pop()
            near = self._at_least(points[every], node) <= bound[every]
            every, node = every[near], node[near]
            if len(every) > MOST_PAIRS:
                half = len(every) // 2
                waiting += [(level, every[half:], node[half:]), (level, every[:half], node[:half])]
            elif level < self._depth:
                every, node = np.repeat(every, 2), (2 * node[:, None] + [1, 2]).ravel()
                _lower(bound, every, self._at_most(points[every], node))
                waiting.append((level + 1, every, node))
            elif len(every):
                owner, triangle = self._in_leaves(every, node)
                apart = self._measured.apart_in_pairs(points[owner], triangle)
                which, at = _least(owner, apart)
                closer = apart[at] < found[which]
                which, at = which[closer], at[closer]
                found[which], nearest[which] = apart[at], triangle[at]
                bound[which] = np.minimum(bound[which], apart[at])
        return nearest

    def above_or_below(self, places: FloatArray) -> tuple[IntArray, IntArray]:
        """Pairs (M,) of places (N, 2) m and triangles whose boxes a vertical through them meets."""
        every, node = np.arange(len(places)), np.zeros(len(places), dtype=int)
        for _ in range(self._depth):
            every, node = np.repeat(every, 2), (2 * node[:, None] + [1, 2]).ravel()
            met = self._meets(places[every], node)
            every, node = every[met], node[met]
        return self._in_leaves(every, node)

    def _meets(self, places: FloatArray, node: IntArray) -> BoolArray:
        low, high = self.low[node, :2], self.high[node, :2]
        return np.asarray(((low <= places) & (places <= high)).all(axis=1))

    def _in_leaves(self, every: IntArray, node: IntArray) -> tuple[IntArray, IntArray]:
        """The points and triangles of pairs of points and leaves."""
        first = LEAF * (node - len(self.low) // 2)
        triangle = (first[:, None] + np.arange(LEAF)).ravel()
        there = triangle < len(self.triangles)
        return np.repeat(every, LEAF)[there], triangle[there]

    def _at_least(self, points: FloatArray, node: IntArray) -> FloatArray:
        """(N,) m², squared distances of points from boxes."""
        gap = np.maximum(self.low[node] - points, points - self.high[node])
        gap = np.maximum(gap, 0.0, out=gap)
        return np.asarray(np.einsum("ni,ni->n", gap, gap))

    def _at_most(self, points: FloatArray, node: IntArray) -> FloatArray:
        """(N,) m², squared, within which a box has a triangle: each of its sides touches one.

        MINMAXDIST of Roussopoulos, Kelley & Vincent (1995).
        """
        low, high = (points - side[node] for side in (self.low, self.high))
        low, high = low * low, high * high
        farther = np.maximum(low, high)
        least = farther.sum(axis=1) - (farther - np.minimum(low, high)).max(axis=1)
        return np.asarray(least * (1.0 + ROUNDING))


def _lower(bound: FloatArray, owner: IntArray, amount: FloatArray) -> None:
    """Lowers bounds (N,), in place, to the least amount of each owner; these are ascending."""
    if len(owner):
        first = np.flatnonzero(np.diff(owner, prepend=-1))
        least = np.minimum.reduceat(amount, first)
        bound[owner[first]] = np.minimum(bound[owner[first]], least)


def _least(owner: IntArray, amount: FloatArray) -> tuple[IntArray, IntArray]:
    """The owners there are, which are ascending, and where the least amount of each is first."""
    first = np.flatnonzero(np.diff(owner, prepend=-1))
    least = np.minimum.reduceat(amount, first)
    at = np.flatnonzero(amount == np.repeat(least, np.diff(first, append=len(owner))))
    at = at[np.flatnonzero(np.diff(owner[at], prepend=-1))]
    return owner[first], at


def _morton(centres: FloatArray) -> IntArray:
    """(F,) codes of centres (F, 3): the bits of the three coordinates, interleaved."""
    low, high = centres.min(axis=0), centres.max(axis=0)
    cells = (centres - low) / np.maximum(high - low, 1e-12) * ((1 << GRID_BITS) - 1)
    cell = cells.astype(np.int64)
    code = np.zeros(len(centres), dtype=np.int64)
    for bit in range(GRID_BITS):
        for axis in range(3):
            code |= ((cell[:, axis] >> bit) & 1) << (3 * bit + axis)
    return code
