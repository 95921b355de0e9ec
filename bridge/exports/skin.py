"""Meshes that an armature deforms, for a rig that performs in its stead."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field

import bpy
from mathutils import Matrix

from ...solver.arrays import FloatArray
from ..accessors import armature_data, current_scene, present
from .shapes import has_shapes

_SOLID = ("MESH", "CURVE", "SURFACE", "FONT")  # types of objects that one sees


@dataclass(frozen=True)
class Skin:
    """Meshes that an armature deforms, and what cannot go into a file with them.

    others: what is seen on the armature beside, as props that hang on it undeformed, and curves and
    texts that it deforms. unapplied: names of modifiers of meshes whose shape keys are kept.
    """

    meshes: tuple[bpy.types.Object, ...] = ()
    others: tuple[bpy.types.Object, ...] = ()
    unapplied: Mapping[bpy.types.Object, tuple[str, ...]] = field(default_factory=dict)


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
    unapplied = {mesh: _unapplied(mesh, armature) for mesh in meshes if has_shapes(mesh)}
    lost = {mesh: names for mesh, names in unapplied.items() if names}
    return Skin(tuple(meshes), tuple(others), lost)


def copy_skin(
    skin: Skin, armature: bpy.types.Object, rig: bpy.types.Object, to_rig: FloatArray
) -> dict[bpy.types.Object, bpy.types.Object]:
    """Copies of the meshes that an armature deforms, which a rig deforms instead, and the meshes.
    to_rig (4, 4): from the armature's space to the rig's."""
    copies = {_copy(thing, armature): thing for thing in skin.meshes}
    with _at_rest(armature):
        graph = bpy.context.evaluated_depsgraph_get()
        meshes = {copy: _as_seen(copy, graph) for copy in copies}
        places = {copy: copy.matrix_world.copy() for copy in copies}
    to_file = Matrix(to_rig.tolist()) @ armature.matrix_world.inverted()
    for copy, mesh in meshes.items():
        mesh.transform(to_file @ places[copy], shape_keys=True)
        copy.data = mesh
        _own_materials(copy)
        copy.constraints.clear()
        copy.parent, copy.parent_type = rig, "OBJECT"
        copy.matrix_parent_inverse = copy.matrix_basis = Matrix()
        _have_deform(copy, armature, rig)
    return copies


def _copy(thing: bpy.types.Object, armature: bpy.types.Object) -> bpy.types.Object:
    """A copy of a mesh's object where it is, in sight, with a modifier for the armature."""
    copy = thing.copy()
    copy.animation_data_clear()
    copy.hide_viewport = copy.hide_select = copy.hide_render = False
    if copy.parent_type == "ARMATURE":
        copy.parent_type = "OBJECT"
    if not _deformers(copy, armature):
        made = copy.modifiers.new("Armature", "ARMATURE")
        made.object = armature  # type: ignore[attr-defined]
    present(current_scene().collection).objects.link(copy)
    return copy


def _as_seen(copy: bpy.types.Object, graph: bpy.types.Depsgraph) -> bpy.types.Mesh:
    """Its mesh with what the modifiers make of it; without that where there are shape keys, which
    are for the vertices that the mesh has itself.

    Exporters would do it too late, when lengths are the file's, or not at all.
    """
    if has_shapes(copy):
        assert isinstance(copy.data, bpy.types.Mesh)
        return copy.data.copy()
    seen = copy.evaluated_get(graph)
    return bpy.data.meshes.new_from_object(seen, preserve_all_data_layers=True, depsgraph=graph)


def _own_materials(copy: bpy.types.Object) -> None:
    """Hand its materials to its mesh: of an object with its own the FBX exporter writes one more
    copy of the mesh, whose shape keys nothing animates."""
    for slot in copy.material_slots:
        material = slot.material
        slot.link = "DATA"
        slot.material = material


def _have_deform(copy: bpy.types.Object, armature: bpy.types.Object, rig: bpy.types.Object) -> None:
    """Let the rig deform a copy in an armature's stead, and nothing else."""
    deformers = _deformers(copy, armature)
    for modifier in list(copy.modifiers):
        if modifier in deformers:
            modifier.object = rig  # type: ignore[attr-defined]
        else:
            copy.modifiers.remove(modifier)


@contextmanager
def _at_rest(armature: bpy.types.Object) -> Iterator[None]:
    """Context in which an armature deforms nothing."""
    data = armature_data(armature)
    was = data.pose_position
    data.pose_position = "REST"
    try:
        yield
    finally:
        data.pose_position = was


def _deformed(thing: bpy.types.Object, armature: bpy.types.Object) -> bool:
    """Whether an armature deforms an object: by a modifier or, without one, as its parent."""
    as_parent = thing.parent == armature and thing.parent_type == "ARMATURE"
    return as_parent or bool(_deformers(thing, armature))


def _deformers(thing: bpy.types.Object, armature: bpy.types.Object) -> list[bpy.types.Modifier]:
    """The modifiers by which an armature deforms an object."""
    found = (each for each in thing.modifiers if isinstance(each, bpy.types.ArmatureModifier))
    return [each for each in found if each.object == armature]


def _unapplied(mesh: bpy.types.Object, armature: bpy.types.Object) -> tuple[str, ...]:
    """Names of the modifiers that are seen, beside the armature's."""
    deformers = _deformers(mesh, armature)
    others = (each for each in mesh.modifiers if each not in deformers)
    return tuple(each.name for each in others if each.show_viewport)
