"""Faces of an evaluated object as arrays of triangles."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ...solver.arrays import FloatArray, IntArray
from ...solver.data.faults import NoFaces, TooManyFaces
from ...solver.scene.checks import MOST_TRIANGLES

SAME = 1e-5  # of its size, by which no vertex moves in a mesh that keeps its shape


@dataclass(frozen=True)
class Triangles:
    """vertices: (V, 3), in the object's own axes and Blender units; corners: (F, 3) indices,
    counter-clockwise seen from outside. Every vertex is a corner."""

    vertices: FloatArray
    corners: IntArray

    def same_shape(self, other: Triangles) -> bool:
        """Whether the vertices of both are at the same places."""
        if self.vertices.shape != other.vertices.shape:
            return False
        size = float(np.ptp(self.vertices, axis=0).max())
        return bool(np.abs(self.vertices - other.vertices).max() <= SAME * size)


def read_triangles(evaluated: bpy.types.Object) -> Triangles:
    """The faces of an object as the dependency graph has it, modifiers applied.

    Raises NoFaces, also where Blender can make no mesh of it, and TooManyFaces.
    """
    try:
        mesh = evaluated.to_mesh()
    except RuntimeError as problem:  # an empty, a light
        raise NoFaces(evaluated.name) from problem
    try:
        vertices, corners = triangles_of(mesh, evaluated.name)
    finally:
        evaluated.to_mesh_clear()
    used = np.zeros(len(vertices), bool)  # loose ones are no part of the surface
    used[corners] = True
    places = np.cumsum(used) - 1
    return Triangles(vertices[used], places[corners])


def triangles_of(mesh: bpy.types.Mesh, name: str) -> tuple[FloatArray, IntArray]:
    """All vertices (V, 3) of a mesh, and the corners (F, 3) of its faces in triangles.

    name: the object's. Raises NoFaces, TooManyFaces.
    """
    mesh.calc_loop_triangles()
    count = len(mesh.loop_triangles)
    if count > MOST_TRIANGLES:  # before they are sent anywhere
        raise TooManyFaces(name, count, MOST_TRIANGLES)
    if not count:
        raise NoFaces(name)
    vertices = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", vertices)
    corners = np.empty(3 * count, np.int32)
    mesh.loop_triangles.foreach_get("vertices", corners)
    return vertices.reshape(-1, 3).astype(float), corners.reshape(-1, 3)
