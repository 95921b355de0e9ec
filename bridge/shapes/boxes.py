"""Boxes and ramps as faces, and faces that are one: what a person says of a solid in three numbers.

Both stand on their base, whose middle is the origin; a ramp rises along x.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...solver.arrays import FloatArray, IntArray
from ...solver.numerics.rotations import axis_rotation

BOX_QUADS = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
# Corners: base 0 to 3, the upper edge 4 and 5.
RAMP_TRIANGLES = (
    (0, 1, 2),
    (0, 2, 3),
    (3, 2, 5),
    (3, 5, 4),
    (0, 4, 5),
    (0, 5, 1),
    (0, 3, 4),
    (1, 5, 2),
)
SAME = 1e-6  # of a solid's size, within which a corner is where it should be; floats of 32 bits

Solid = tuple[FloatArray, IntArray]  # vertices (V, 3) m, triangles (F, 3)


def box_solid(size: FloatArray) -> Solid:
    """The box of size (3,)."""
    return box_corners(size), _triangles(BOX_QUADS)


def box_corners(size: FloatArray) -> FloatArray:
    """(8, 3) corners of `BOX_QUADS`."""
    shares = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=float)
    return np.asarray((shares - [0.5, 0.5, 0.0]) * size)


def ramp_solid(size: FloatArray) -> Solid:
    """The ramp of size (3,): length along x, width, and height to which it rises."""
    corners = [[-1, -1, 0], [-1, 1, 0], [1, 1, 0], [1, -1, 0], [1, -1, 1], [1, 1, 1]]
    shares = np.array(corners, dtype=float) * [0.5, 0.5, 1.0]
    return shares * size, np.array(RAMP_TRIANGLES)


def _triangles(quads: Sequence[tuple[int, int, int, int]]) -> IntArray:
    return np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])


SOLIDS: Mapping[str, Callable[[FloatArray], Solid]] = {"box": box_solid, "ramp": ramp_solid}


@dataclass(frozen=True)
class Known:
    """A solid in three numbers. kind: of `SOLIDS`. size: (3,) m. base: (3,) m, where its origin is
    in the mesh's axes; turn: (3, 3), its axes in these."""

    kind: str
    size: FloatArray
    base: FloatArray
    turn: FloatArray


def known_solid(vertices: FloatArray, triangles: IntArray) -> Known | None:
    """The box or ramp that a mesh is, whatever the order of its corners and faces; else None."""
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    size = high - low
    if not (size > 0.0).all():
        return None
    base = np.array([*(0.5 * (low + high))[:2], low[2]])
    for kind, solid in SOLIDS.items():
        for quarter in range(4):
            turn = np.round(axis_rotation(2, 0.5 * np.pi * quarter))
            sizes = np.abs(turn.T @ size)
            if _same_solid(solid(sizes), ((vertices - base) @ turn, triangles), SAME * size.max()):
                return Known(kind, sizes, base, turn)
    return None


def _same_solid(one: Solid, other: Solid, tolerance: float) -> bool:
    """Whether corners are the same, and the faces, however these are cut into triangles: closed
    faces on the corners of a convex solid that have its volume are its own."""
    if len(one[0]) != len(other[0]) or not _closed(other[1]):
        return False
    apart = np.linalg.norm(one[0][:, None] - other[0][None], axis=2)
    met = max(apart.min(axis=0).max(), apart.min(axis=1).max()) <= tolerance
    return bool(met and np.isclose(_volume(one), _volume(other), rtol=1e-5))


def _volume(solid: Solid) -> float:
    a, b, c = np.moveaxis(solid[0][solid[1]], 1, 0)
    return float(np.einsum("fi,fi->", a, np.cross(b, c)) / 6.0)


def _closed(triangles: IntArray) -> bool:
    """Whether every edge is run along both ways, once each."""
    edges = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2)
    ways = {(a, b) for a, b in edges.tolist()}
    return len(ways) == len(edges) and all((b, a) in ways for a, b in ways)
