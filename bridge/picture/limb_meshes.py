"""Meshes of the body's limbs, from the boxes they fill: no Blender."""

import numpy as np

from ...solver.arrays import FloatArray
from ..shapes.mesh import Mesh
from ..shapes.solids import superellipsoid

AROUND, ALONG = 28, 20  # faces of a ball or a limb
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
        return _filling(size * (6 / np.pi) ** (1 / 3), 2, ends=1.0, section=1.0)
    if size[longest] > SLENDER * np.median(size):
        return _filling(size, longest, ends=0.42, section=0.95, taper=0.24 * proximal)
    if size[2] < FLAT * np.sqrt(size[0] * size[1]):
        return _filling(size * np.array([0.88, 0.88, 2.1]), 2, ends=0.7, section=0.85)
    return _filling(size, longest, ends=0.5, section=0.75, taper=0.06 * proximal)


def ball(radius: float) -> Mesh:
    """A sphere around the origin."""
    return _filling(np.full(3, 2 * radius), 2, ends=1.0, section=1.0)


def _filling(
    size: FloatArray, axis: int, *, ends: float, section: float, taper: float = 0.0
) -> Mesh:
    """A superellipsoid about an axis in a box of the given extents (3,)."""
    mesh = superellipsoid(AROUND, ALONG, ends=ends, section=section, taper=taper)
    # rolling the axes, which swaps none, keeps the faces pointing outwards
    return Mesh(np.roll(mesh.points, axis + 1, axis=1) * size / 2, mesh.faces)
