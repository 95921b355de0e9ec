"""Faces of the ground as trees for ray casts: where a pin lands. Blender units, world."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Vector
from mathutils.bvhtree import BVHTree

from ...solver.arrays import FloatArray
from ...solver.data.faults import SceneFault
from ..armature.incremental import complete
from .members import Member
from .mesh import Triangles, read_triangles
from .seen import seen_at, simulate

STEEP = 0.3  # of a face's unit normal along the vertical; below, nobody stands on it
ABOVE = 1.0  # by how much rays begin above the highest vertex


@dataclass(frozen=True)
class GroundPoint:
    """A place on a face of an object."""

    object: bpy.types.Object
    place: Vector


@dataclass(frozen=True)
class _Tree:
    object: bpy.types.Object
    tree: BVHTree
    top: float


class GroundFaces:
    """The ground's faces at one frame."""

    def __init__(self, trees: Sequence[_Tree]) -> None:
        self._trees = trees
        self._top = max((each.top for each in trees), default=0.0) + ABOVE

    def below(self, x: float, y: float) -> GroundPoint | None:
        """The highest face at a place that somebody could stand on."""
        return self.seen(np.array([x, y, self._top]), np.array([0.0, 0.0, -1.0]))

    def seen(self, origin: FloatArray, along: FloatArray) -> GroundPoint | None:
        """The face that a ray from (3,) along (3,) meets first, if somebody could stand on it."""
        nearest, found = np.inf, None
        for each in self._trees:
            place, normal, _, distance = each.tree.ray_cast(origin.tolist(), along.tolist())
            if place is None or normal is None or distance is None or distance >= nearest:
                continue
            nearest = distance
            found = GroundPoint(each.object, place) if abs(normal.z) > STEEP else None
        return found


def ground_faces(of: Sequence[Member], frame: float) -> GroundFaces:
    """Faces of ground where it is at a scene frame; what has none is left out, as the solver's
    reading tells of it. The scene's frame is afterwards what it was."""
    objects = [member.object for member in of]
    complete(simulate(objects, frame))
    found = seen_at(objects, np.array([frame]), _placed)[0]
    return GroundFaces(
        [_Tree(each, *placed) for each, placed in zip(objects, found, strict=True) if placed]
    )


def _placed(evaluated: bpy.types.Object) -> tuple[BVHTree, float] | None:
    """The tree of an object's faces, and its highest vertex."""
    try:
        shape: Triangles = read_triangles(evaluated)
    except SceneFault:
        return None
    matrix = np.array(evaluated.matrix_world, float)
    vertices = shape.vertices @ matrix[:3, :3].T + matrix[:3, 3]
    faces = vertices.tolist(), shape.corners.tolist()
    # a tree, whatever the stubs say
    tree: BVHTree = BVHTree.FromPolygons(*faces, all_triangles=True)  # type: ignore[assignment]
    return tree, float(vertices[:, 2].max())
