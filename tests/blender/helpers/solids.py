"""Solid objects for tests: made from nothing, and read as the operators read them."""

from __future__ import annotations

import bpy
import numpy as np
from hangtime.bridge.armature.incremental import complete
from hangtime.bridge.scene.members import members
from hangtime.bridge.scene.read import SceneReading, read_scene
from hangtime.solver.data.scene import SceneObject
from hangtime.tests.blender.helpers import rigs

FRAMES = np.arange(1.0, 11.0)


def make_armature() -> bpy.types.Object:
    """An armature in an empty scene."""
    rigs.reset()
    return rigs.make_armature()


def make_box(
    name: str = "Crate", at: tuple[float, float, float] = (0.0, 0.0, 0.0), size: float = 1.0
) -> bpy.types.Object:
    """A cube about `at`."""
    bpy.ops.mesh.primitive_cube_add(size=size, location=at)
    box = bpy.context.object
    box.name = name
    return box


def add_row(
    armature: bpy.types.Object, solid: bpy.types.Object, role: str = "GROUND"
) -> bpy.types.PropertyGroup:
    row = armature.hangtime.surfaces.add()
    row.object, row.name, row.role = solid, solid.name, role
    return row


def read(armature: bpy.types.Object, frames: np.ndarray = FRAMES) -> SceneReading:
    """The armature's surfaces at frames."""
    return complete(read_scene(members(armature.hangtime, bpy.context.scene), frames))


def read_one(armature: bpy.types.Object) -> SceneObject:
    (only,) = read(armature).objects
    return only


def in_world(solid: SceneObject, instant: int = 0) -> np.ndarray:
    """(V, 3) m, world."""
    return solid.vertices @ solid.rotations[instant].T + solid.positions[instant]


def volume(solid: SceneObject) -> float:
    """Of a closed mesh, m³; negative where it is inside out."""
    a, b, c = (solid.vertices[solid.triangles[:, k]] for k in range(3))
    return float(np.einsum("ni,ni->n", a, np.cross(b, c)).sum() / 6.0)
