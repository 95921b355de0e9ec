"""Meshes that an armature deforms, for a rig that performs in its stead."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
from mathutils import Matrix

from ...solver.arrays import FloatArray
from ..accessors import current_scene, present

_SOLID = ("MESH", "CURVE", "SURFACE", "FONT")  # types of objects that one sees


@dataclass(frozen=True)
class Skin:
    """Meshes that an armature deforms, and what is seen on it beside: props that hang on it
    undeformed, and curves and texts that it deforms. Only meshes can go into a file."""

    meshes: tuple[bpy.types.Object, ...] = ()
    others: tuple[bpy.types.Object, ...] = ()


def skin_of(armature: bpy.types.Object) -> Skin:
    """The skin in the scene. Hidden meshes are left out, unless the armature is hidden as well."""
    all_hidden = not armature.visible_get()
    meshes, others = [], []
    for thing in current_scene().objects:
        deformed, seen = _deformed(thing, armature), thing.visible_get()
        if deformed and thing.type == "MESH" and (seen or all_hidden):
            meshes.append(thing)
        elif seen and thing.type in _SOLID and (deformed or thing.parent == armature):
            others.append(thing)
    return Skin(tuple(meshes), tuple(others))


def copy_skin(
    skin: Skin, armature: bpy.types.Object, rig: bpy.types.Object, to_rig: FloatArray
) -> dict[bpy.types.Object, str]:
    """Copies of the meshes that an armature deforms, which a rig deforms instead, and the meshes'
    names. to_rig (4, 4): from the armature's space to the rig's."""
    made = {}
    for thing in skin.meshes:
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
        for modifier in _deformers(copy, armature) or [copy.modifiers.new("Armature", "ARMATURE")]:
            modifier.object = rig  # type: ignore[attr-defined]
        present(current_scene().collection).objects.link(copy)
        made[copy] = thing.name
    return made


def _deformed(thing: bpy.types.Object, armature: bpy.types.Object) -> bool:
    """Whether an armature deforms an object: by a modifier or, without one, as its parent."""
    as_parent = thing.parent == armature and thing.parent_type == "ARMATURE"
    return as_parent or bool(_deformers(thing, armature))


def _deformers(thing: bpy.types.Object, armature: bpy.types.Object) -> list[bpy.types.Modifier]:
    """The modifiers by which an armature deforms an object."""
    found = (each for each in thing.modifiers if isinstance(each, bpy.types.ArmatureModifier))
    return [each for each in found if each.object == armature]
