"""Objects of the solver's scene as mesh objects of Blender."""

import bpy
import numpy as np
from mathutils import Matrix

from ...solver.arrays import FloatArray
from ...solver.data.scene import SceneObject
from ..accessors import current_scene


def build_scene(things: tuple[SceneObject, ...]) -> None:
    """Adds objects to the current scene, with keys where they move."""
    for thing in things:
        mesh = bpy.data.meshes.new(thing.name)
        mesh.from_pydata(thing.vertices.tolist(), [], thing.triangles.tolist())
        made = bpy.data.objects.new(thing.name, mesh)
        current_scene().collection.objects.link(made)
        made.rotation_mode = "QUATERNION"
        poses = zip(thing.frames.tolist(), thing.positions, thing.rotations, strict=True)
        for frame, place, turn in poses:
            made.matrix_world = _matrix(place, turn)
            if thing.moves:
                made.keyframe_insert("location", frame=frame)
                made.keyframe_insert("rotation_quaternion", frame=frame)


def _matrix(place: FloatArray, turn: FloatArray) -> Matrix:
    whole = np.eye(4)
    whole[:3, :3], whole[:3, 3] = turn, place
    return Matrix(whole.tolist())
