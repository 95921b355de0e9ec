"""Boxes that the analysis offers, as mesh objects of the scene."""

from __future__ import annotations

import bpy
import numpy as np
from mathutils import Matrix

from ...solver.data.scene import SupportBox
from ..accessors import current_scene
from ..armature.poses import metres_per_unit
from ..properties.settings import settings_of
from ..shapes.boxes import BOX_QUADS, box_corners

NAME = "Box"
MARK = "hangtime_support"  # of the object, whatever the artist calls it


def add_support_box(box: SupportBox) -> bpy.types.Object:
    """A mesh object in the scene's collection, its origin in the middle of its base."""
    metres = metres_per_unit(current_scene())
    mesh = bpy.data.meshes.new(NAME)
    mesh.from_pydata((box_corners(np.array(box.size)) / metres).tolist(), [], BOX_QUADS)
    made = bpy.data.objects.new(NAME, mesh)
    made[MARK] = True
    x, y, z = (value / metres for value in box.place)
    made.matrix_world = Matrix.Translation((x, y, z)) @ Matrix.Rotation(box.turn, 4, "Z")
    current_scene().collection.objects.link(made)
    return made


def carry_along(armature: bpy.types.Object, by: Matrix) -> None:
    """Moves the boxes that were offered for a recording, and are among its surfaces, with it."""
    for row in settings_of(armature).surfaces:
        if row.object is not None and row.object.get(MARK):
            row.object.matrix_world = by @ row.object.matrix_world
