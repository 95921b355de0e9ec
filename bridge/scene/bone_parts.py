"""A mesh that an armature bends, as stiff parts: each the convex hull of what a bone carries.

So physics engines take characters. What a bone carries is told by the weights, as for the skin.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from functools import partial

import bmesh
import bpy
import numpy as np

from ...solver.arrays import FloatArray, IntArray
from ..accessors import armature_data, current_scene, pose_of
from ..armature.incremental import Incremental, in_slices
from ..armature.poses import metres_per_unit
from .mesh import Triangles, triangles_of
from .seen import Showing, seen_at
from .weights import heaviest_bones

SMALL = 0.08  # m; a bone that carries less goes with the one that it hangs on, as fingers do
DIRECTIONS = 200  # whose farthest vertices span a hull: of a ball it lacks 2 %
GOLDEN = np.pi * (3.0 - np.sqrt(5.0))


@dataclass(frozen=True)
class BonePart:
    """shape: in the bone's axes as they are at the first frame. matrices: (T, 4, 4), bone to world,
    Blender units."""

    bone: str
    shape: Triangles
    matrices: FloatArray


def read_bone_parts(
    thing: bpy.types.Object,
    armature: bpy.types.Object,
    frames: FloatArray,
    showing: Showing = nullcontext,
) -> Incremental[tuple[BonePart, ...]]:
    """The parts of a mesh at frames (T,); none where a vertex is no bone's. showing: as of
    `in_slices`."""
    looks = yield from in_slices(frames[:1], partial(_carried, thing, armature), showing)
    shapes = looks[0]
    if not shapes:
        return ()
    bones = tuple(shapes)
    found = yield from in_slices(frames, partial(_bones, armature, bones), showing)
    matrices = np.concatenate(found)
    return tuple(
        BonePart(bone, _hull(_placed(shapes[bone], np.linalg.inv(way[0]))), way)
        for bone, way in zip(bones, np.swapaxes(matrices, 0, 1), strict=True)
    )


def _bones(armature: bpy.types.Object, bones: Sequence[str], frames: FloatArray) -> FloatArray:
    """(T, B, 4, 4) bones to world at frames (T,), Blender units."""

    def look(posed: bpy.types.Object) -> FloatArray:
        own = np.array([pose_of(posed).bones[bone].matrix for bone in bones], float)
        return np.asarray(np.array(posed.matrix_world, float) @ own)

    return np.array([found for (found,) in seen_at([armature], frames, look)])


def _carried(
    thing: bpy.types.Object, armature: bpy.types.Object, frames: FloatArray
) -> dict[str, Triangles]:
    """What each bone carries at the first of frames (T,), in the world, Blender units; nothing
    where a vertex is no bone's."""
    bones = [bone.name for bone in armature_data(armature).bones]

    def look(evaluated: bpy.types.Object) -> tuple[Triangles, IntArray]:
        index = {name: i for i, name in enumerate(bones)}
        bone_of = [index.get(group.name, -1) for group in evaluated.vertex_groups]
        graph = bpy.context.evaluated_depsgraph_get()
        mesh = evaluated.to_mesh(preserve_all_data_layers=True, depsgraph=graph)
        try:
            vertices, corners = triangles_of(mesh, evaluated.name)
            used, places = np.unique(corners, return_inverse=True)
            faces = Triangles(vertices[used], places.reshape(-1, 3))
            owners = heaviest_bones(mesh, used, bone_of) if bone_of else np.full(len(used), -1)
            return _placed(faces, np.array(evaluated.matrix_world, float)), owners
        finally:
            evaluated.to_mesh_clear()

    faces, owners = seen_at([thing], frames, look)[0][0]
    if owners.min() < 0:
        return {}
    _join_small(faces.vertices, owners, _parents(armature, bones))
    return {bones[i]: _faces_of(faces, owners == i) for i in np.unique(owners).tolist()}


def _placed(shape: Triangles, matrix: FloatArray) -> Triangles:
    return Triangles(shape.vertices @ matrix[:3, :3].T + matrix[:3, 3], shape.corners)


def _parents(armature: bpy.types.Object, bones: Sequence[str]) -> list[list[int]]:
    """Of each bone those that it hangs on, nearest first."""
    index = {name: i for i, name in enumerate(bones)}
    every = armature_data(armature).bones
    return [[index[above.name] for above in every[name].parent_recursive] for name in bones]


def _join_small(vertices: FloatArray, owners: IntArray, parents: Sequence[Sequence[int]]) -> None:
    """Gives what small parts own of vertices (V, 3) to the nearest that their bone hangs on and
    that has some; owners (V,) are changed."""
    small = SMALL / metres_per_unit(current_scene())
    there = set(np.unique(owners).tolist())
    for i in sorted(there, key=lambda i: -len(parents[i])):
        above = next((each for each in parents[i] if each in there), None)
        if above is not None and np.ptp(vertices[owners == i], axis=0).max() < small:
            owners[owners == i] = above


def _faces_of(faces: Triangles, own: FloatArray) -> Triangles:
    """The faces that have one of a bone's own vertices (V,), so that no gap is between parts."""
    corners = faces.corners[own[faces.corners].any(axis=1)]
    used, places = np.unique(corners, return_inverse=True)
    return Triangles(faces.vertices[used], places.reshape(-1, 3))


def _hull(shape: Triangles) -> Triangles:
    """The convex hull of a shape; of one that is flat the shape itself."""
    z = 1.0 - (2.0 * np.arange(DIRECTIONS) + 1.0) / DIRECTIONS
    around = GOLDEN * np.arange(DIRECTIONS)
    level = np.sqrt(1.0 - z**2)
    ways = np.stack([level * np.cos(around), level * np.sin(around), z])
    farthest = np.unique((shape.vertices @ ways).argmax(axis=0))
    made = bmesh.new()
    try:
        for place in shape.vertices[farthest]:
            made.verts.new(place)
        bmesh.ops.convex_hull(made, input=made.verts[:])
        bmesh.ops.triangulate(made, faces=made.faces[:])
        bmesh.ops.recalc_face_normals(made, faces=made.faces[:])
        made.verts.index_update()
        vertices = np.array([each.co for each in made.verts], float)
        corners = np.array([[v.index for v in face.verts] for face in made.faces], int)
        if len(corners) < 4 or not made.calc_volume() > 0.0:
            return shape
    finally:
        made.free()
    used, places = np.unique(corners, return_inverse=True)
    return Triangles(vertices[used], places.reshape(-1, 3))
