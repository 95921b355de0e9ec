"""Meshes of the picture as vertex and face arrays: no Blender."""

import numpy as np
from numpy.typing import NDArray

from ...solver.arrays import FloatArray

IntArray = NDArray[np.int64]
Mesh = tuple[FloatArray, IntArray]  # (V, 3) vertices m, (F, 4) faces

AROUND, ALONG = 28, 20
TUBE = 10  # corners of a line's cross-section
FLAT = 0.75  # a body shorter than this share of its width is a slice of the trunk
SLENDER = 1.7  # a body this many times longer than wide is drawn as a tapered limb


def limb(size: FloatArray, proximal: float, *, head: bool = False) -> Mesh:
    """A pleasant solid for a box of the given extents (3,).

    Slender boxes become limbs that taper away from the proximal end (+1 or -1 on the longest
    axis), heads ellipsoids of the box's volume, slices of the trunk blobs that overlap their
    neighbours, the rest rounded blocks.
    """
    longest = int(np.argmax(size))
    if head:
        return _superellipsoid(size * (6 / np.pi) ** (1 / 3), 2, ends=1.0, section=1.0)
    if size[longest] > SLENDER * np.median(size):
        return _superellipsoid(size, longest, ends=0.42, section=0.95, taper=0.24 * proximal)
    if size[2] < FLAT * np.sqrt(size[0] * size[1]):
        blob = size * np.array([0.88, 0.88, 2.1])
        return _superellipsoid(blob, 2, ends=0.7, section=0.85)
    return _superellipsoid(size, longest, ends=0.5, section=0.75, taper=0.06 * proximal)


def ball(radius: float) -> Mesh:
    """A sphere around the origin."""
    return _superellipsoid(np.full(3, 2 * radius), 2, ends=1.0, section=1.0)


def block(low: FloatArray, high: FloatArray) -> Mesh:
    """The box between two corners (3,)."""
    corners = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=float)
    faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    return low + corners * (high - low), np.array(faces)


def band(one: FloatArray, other: FloatArray) -> Mesh:
    """The surface between two lines of (N, 3) points each."""
    n = len(one)
    k = np.arange(n - 1)
    return np.concatenate([one, other]), np.stack([k, k + 1, k + 1 + n, k + n], axis=1)


def tube(points: FloatArray, radius: float) -> Mesh:
    """A round line through (N, 3) points; closed where the last one is the first."""
    closed = bool(np.allclose(points[0], points[-1]))
    ahead = np.diff(points, axis=0)
    ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
    first, last = (ahead[-1:], ahead[:1]) if closed else (ahead[:1], ahead[-1:])
    along = np.concatenate([first, ahead]) + np.concatenate([ahead, last])
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    # one direction that no part of the line runs along keeps the rings from twisting
    fixed = np.eye(3)[np.abs(along).max(axis=0).argmin()]
    side = np.cross(along, fixed)
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    turn = np.linspace(0.0, 2 * np.pi, TUBE, endpoint=False)[:, None, None]
    rings = points + radius * (np.cos(turn) * side + np.sin(turn) * np.cross(along, side))
    if not closed:  # the ends are drawn together to caps
        rings = np.concatenate(
            [np.tile(points[0], (TUBE, 1, 1)), rings, np.tile(points[-1], (TUBE, 1, 1))], axis=1
        )
    n = rings.shape[1]
    k, step = np.meshgrid(np.arange(n - 1), np.arange(TUBE), indexing="ij")
    a, b = step * n + k, (step + 1) % TUBE * n + k
    return rings.reshape(-1, 3), np.stack([a, b, b + 1, a + 1], axis=-1).reshape(-1, 4)


def _superellipsoid(
    size: FloatArray, axis: int, *, ends: float, section: float, taper: float = 0.0
) -> Mesh:
    """Exponents near 0 give boxes, 1 ellipsoids; `taper` widens towards the axis's positive end."""
    phi, theta = np.meshgrid(
        np.linspace(-np.pi / 2, np.pi / 2, ALONG + 1),
        np.linspace(0.0, 2 * np.pi, AROUND, endpoint=False),
        indexing="ij",
    )
    along = _power(np.sin(phi), ends)
    radius = _power(np.cos(phi), ends) * (1 + taper * along)
    unit = np.stack(
        [
            radius * _power(np.cos(theta), section),
            radius * _power(np.sin(theta), section),
            along,
        ],
        axis=-1,
    )
    # the cyclic order keeps the faces pointing outwards
    order = [(axis + 1) % 3, (axis + 2) % 3, axis]
    vertices = np.zeros((unit.shape[0] * unit.shape[1], 3))
    vertices[:, order] = unit.reshape(-1, 3)
    ring, step = np.meshgrid(np.arange(ALONG), np.arange(AROUND), indexing="ij")
    a, b = ring * AROUND + step, ring * AROUND + (step + 1) % AROUND
    faces = np.stack([a, b, b + AROUND, a + AROUND], axis=-1).reshape(-1, 4)
    return vertices * size / 2, faces


def _power(x: FloatArray, exponent: float) -> FloatArray:
    return np.sign(x) * np.abs(x) ** exponent
