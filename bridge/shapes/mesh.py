"""Meshes as arrays of points and quadrilaterals, and surfaces over grids of points: numpy only."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...solver.arrays import FloatArray, IntArray


@dataclass(frozen=True)
class Mesh:
    """points: (V, 3). faces: (F, 4) indices of corners, counter-clockwise from outside."""

    points: FloatArray
    faces: IntArray

    @property
    def edges(self) -> FloatArray:
        """(E, 2, 3) ends of the faces' edges, each edge once."""
        ends = np.stack([self.faces, np.roll(self.faces, -1, axis=1)], axis=-1).reshape(-1, 2)
        return np.asarray(self.points[np.unique(np.sort(ends, axis=1), axis=0)])

    def placed(self, axes: FloatArray, origin: FloatArray) -> Mesh:
        """The mesh along the columns of axes (3, 3), about a point (3,)."""
        return Mesh(self.points @ axes.T + origin, self.faces)


def joined(meshes: Sequence[Mesh]) -> Mesh:
    """One mesh of several, at least one."""
    first = np.cumsum([0, *(len(mesh.points) for mesh in meshes[:-1])])
    faces = [mesh.faces + start for mesh, start in zip(meshes, first, strict=True)]
    return Mesh(np.concatenate([mesh.points for mesh in meshes]), np.concatenate(faces))


def grid_faces(rows: int, columns: int, *, wraps: bool = False) -> IntArray:
    """(F, 4) faces between rows x columns points, row by row.

    wraps: whether the last column is joined to the first.
    """
    i, j = np.arange(rows - 1)[:, None], np.arange(columns if wraps else columns - 1)
    a, b = i * columns + j, i * columns + (j + 1) % columns
    return np.asarray(np.stack([a, b, b + columns, a + columns], axis=-1).reshape(-1, 4))


def band(one: FloatArray, other: FloatArray) -> Mesh:
    """The surface between two lines of (N, 3) points each."""
    return Mesh(np.concatenate([one, other]), grid_faces(2, len(one)))


def quartered(points: FloatArray, triangles: IntArray) -> Mesh:
    """The mesh of points (V, 3) and triangles (F, 3), each as three faces of four corners."""
    corners = points[triangles]
    middles = 0.5 * (corners + np.roll(corners, -1, axis=1))
    centres = corners.mean(axis=1, keepdims=True)
    places = np.concatenate([corners, middles, centres], axis=1).reshape(-1, 3)
    one = np.array([[0, 3, 6, 5], [1, 4, 6, 3], [2, 5, 6, 4]])
    return Mesh(places, (7 * np.arange(len(triangles))[:, None, None] + one).reshape(-1, 4))
