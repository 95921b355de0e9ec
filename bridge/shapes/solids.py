"""Superellipsoids, balls, boxes and tubes."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ...solver.arrays import FloatArray
from .mesh import Mesh, grid_faces


def superellipsoid(
    around: int, along: int, *, ends: float = 1.0, section: float = 1.0, taper: float = 0.0
) -> Mesh:
    """A solid about z that fills the cube from -1 to 1 (Barr 1981).

    ends, section: exponents along and across; near 0 they give boxes, 1 balls. taper: how much
    wider it is towards +z. around, along: numbers of faces.
    """
    phi, theta = np.meshgrid(
        np.linspace(-np.pi / 2, np.pi / 2, along + 1),
        np.linspace(0.0, 2 * np.pi, around, endpoint=False),
        indexing="ij",
    )
    z = _power(np.sin(phi), ends)
    radius = _power(np.cos(phi), ends) * (1 + taper * z)
    x, y = radius * _power(np.cos(theta), section), radius * _power(np.sin(theta), section)
    points = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    return Mesh(points, grid_faces(along + 1, around, wraps=True))


def _power(x: FloatArray, exponent: float) -> FloatArray:
    return np.asarray(np.sign(x) * np.abs(x) ** exponent)


def box(low: ArrayLike, high: ArrayLike) -> Mesh:
    """The box between two corners (3,)."""
    shares = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=float)
    faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    start, end = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
    return Mesh(start + shares * (end - start), np.array(faces))


def tube(line: FloatArray, radius: float, around: int = 10) -> Mesh:
    """A round tube along a line of (N, 3) points; closed where the last one is the first.

    around: number of faces.
    """
    closed = bool(np.allclose(line[0], line[-1]))
    ahead = np.diff(line, axis=0)
    ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
    first, last = (ahead[-1:], ahead[:1]) if closed else (ahead[:1], ahead[-1:])
    along = np.concatenate([first, ahead]) + np.concatenate([ahead, last])
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    # one direction that no part of the line runs along keeps the rings from twisting
    fixed = np.eye(3)[np.abs(along).max(axis=0).argmin()]
    side = np.cross(along, fixed)
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    turn = np.linspace(0.0, 2 * np.pi, around, endpoint=False)[:, None]
    out = np.cos(turn) * side[:, None] + np.sin(turn) * np.cross(along, side)[:, None]
    rings = line[:, None] + radius * out
    if not closed:  # the ends are drawn together to caps
        ends = np.repeat(line[[0, -1], None], around, axis=1)
        rings = np.concatenate([ends[:1], rings, ends[1:]])
    return Mesh(rings.reshape(-1, 3), grid_faces(len(rings), around, wraps=True))
