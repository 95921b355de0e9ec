"""Meshes that an armature deforms, for a rig that performs in its stead."""

from __future__ import annotations

import bpy
from mathutils import Matrix

from ...solver.arrays import FloatArray
from ..accessors import current_scene, present


def copy_skin(
    armature: bpy.types.Object, rig: bpy.types.Object, to_rig: FloatArray
) -> dict[bpy.types.Object, str]:
    """Copies of the meshes that an armature deforms, which a rig deforms instead, and the meshes'
    names. Hidden ones are left out, unless the armature is hidden as well. to_rig (4, 4): from the
    armature's space to the rig's."""
    made, all_hidden = {}, not armature.visible_get()
    for thing in list(current_scene().objects):
        if not any(_deforms(armature, modifier) for modifier in thing.modifiers):
            continue
        if not (thing.visible_get() or all_hidden):
            continue
        copy = thing.copy()
        mesh = present(thing.data).copy()
        assert isinstance(mesh, bpy.types.Mesh)
        copy.data = mesh
        inside = armature.matrix_world.inverted() @ thing.matrix_world
        mesh.transform(Matrix(to_rig.tolist()) @ inside, shape_keys=True)
        copy.animation_data_clear()
        copy.constraints.clear()
        copy.parent, copy.parent_type = rig, "OBJECT"
        copy.matrix_parent_inverse = copy.matrix_basis = Matrix()
        for modifier in copy.modifiers:
            if _deforms(armature, modifier):
                modifier.object = rig  # type: ignore[attr-defined]
        present(current_scene().collection).objects.link(copy)
        made[copy] = thing.name
    return made


def _deforms(armature: bpy.types.Object, modifier: bpy.types.Modifier) -> bool:
    """Whether a mesh's modifier is the armature's."""
    return isinstance(modifier, bpy.types.ArmatureModifier) and modifier.object == armature
