"""The list of surfaces: add what is selected, or a collection; remove; select what a row names."""

from collections.abc import Iterable

import bpy

from ...bridge.accessors import present
from ...bridge.properties.settings import HangtimeSettings, scene_settings, settings_of
from ...bridge.properties.surface import SOLID_TYPES, HangtimeSurface
from ...bridge.rows.choices import SurfaceRole
from ...bridge.scene.members import ground_members, is_gone, objects_of
from ...bridge.scene.skin import skinned_meshes
from ..names import OperatorId
from ..operator_types import OperatorResult
from ..solve.common import required_armature
from .row_lists import AddingOperator, RemoveOperator, RowList, RowOperator

NOTHING_SOLID = "Select objects with faces first: the ground, a crate, a wall"
SCENES_OWN = "Choose a collection in the outliner first, not the scene's own"
NOT_IN_OBJECT_MODE = "Go to object mode first"
GONE = "“{}” is not in the scene any more"
NOT_SHOWN = "Nothing of “{}” is shown in this view layer"


class AddSurfacesOperator(AddingOperator, bpy.types.Operator):
    bl_idname = OperatorId.ADD_SURFACES
    bl_label = "Add Surfaces"
    bl_description = "Let the selected objects, or the active collection, be solid"

    role: bpy.props.EnumProperty(
        name="Role", items=[(each.name, each.value, "") for each in SurfaceRole]
    )
    collection: bpy.props.BoolProperty(
        name="Collection",
        description="All objects of the active collection, as one row, instead of those selected",
        options={"SKIP_SAVE"},
    )

    @classmethod
    def description(
        cls, _context: bpy.types.Context, properties: bpy.types.OperatorProperties
    ) -> str:
        what = "every object of the active collection" if properties.collection else "the selection"
        if properties.role == SurfaceRole.GROUND.name:
            return f"Let feet land on {what}, and limbs keep out of it"
        if properties.role == SurfaceRole.CLEAR.name:
            return f"Let the way go over {what}, as over a hurdle"
        return f"Let limbs keep out of {what}"

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        settings = settings_of(required_armature(context))
        if self.collection:
            collection = present(context.collection)
            if collection == present(context.scene).collection:  # no property can hold it
                return self.refuse(SCENES_OWN, "WARNING")
            row = row_of(settings, collection)
            row.collection, row.name, row.role = collection, collection.name, self.role
            return {"FINISHED"}
        chosen = _with_faces(context.selected_objects, but=present(settings.id_data))
        if not chosen:
            return self.refuse(NOTHING_SOLID, "WARNING")
        for each in chosen:
            row = row_of(settings, each)
            row.object, row.name, row.role = each, each.name, self.role
        return {"FINISHED"}


class RemoveSurfaceOperator(RemoveOperator, bpy.types.Operator):
    bl_idname = OperatorId.REMOVE_SURFACE
    bl_label = "Remove Surface"
    bl_description = "Take the chosen surface off the list; contacts on it stay where they are"
    of = RowList.SURFACES

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        result = super().execute(context)
        settings = settings_of(required_armature(context))
        ground = [each.object for each in ground_members(settings, present(context.scene))]
        for contact in settings.contacts:
            if contact.on is not None and contact.on not in ground:
                contact.on = None
        return result


class SelectSurfaceOperator(RowOperator, bpy.types.Operator):
    bl_idname = OperatorId.SELECT_SURFACE
    bl_label = "Select Surface"
    bl_description = "Select the objects of the chosen row in the scene"
    of = RowList.SURFACES

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        why = super().obstacle(context)
        return NOT_IN_OBJECT_MODE if why is None and context.mode != "OBJECT" else why

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        armature, layer = required_armature(context), present(context.view_layer)
        settings = settings_of(armature)
        row: HangtimeSurface = settings.surfaces[RowList.SURFACES.chosen(settings)]
        if is_gone(row, present(context.scene)):
            return self.refuse(GONE.format(row.called), "WARNING")
        shown = [o for o in objects_of(row) if o.visible_get(view_layer=layer)]
        if not shown:
            return self.refuse(NOT_SHOWN.format(row.called), "WARNING")
        bpy.ops.object.select_all(action="DESELECT")
        for each in shown:
            each.select_set(True, view_layer=layer)
        layer.objects.active = shown[0]
        # The choice in the sidebar outlives that another object is active now.
        scene_settings(context.scene).armature = armature
        return {"FINISHED"}


def _with_faces(
    selected: Iterable[bpy.types.Object], but: bpy.types.ID
) -> tuple[bpy.types.Object, ...]:
    """What of a selection is solid, and the meshes that its armatures bend, `but` one's."""
    found = dict[bpy.types.Object, None]()
    for each in selected:
        if each.type in SOLID_TYPES:
            found[each] = None
        elif each.type == "ARMATURE" and each != but:
            found |= dict.fromkeys(skinned_meshes(each))
    return tuple(found)


def row_of(
    settings: HangtimeSettings, named: bpy.types.Object | bpy.types.Collection
) -> HangtimeSurface:
    """The row of an object or a collection, a new one at the end where it has none; chosen."""
    rows = settings.surfaces
    owners = [row.object or row.collection for row in rows]
    index = owners.index(named) if named in owners else len(rows)
    settings.active_surface = index
    row: HangtimeSurface = rows[index] if index < len(rows) else rows.add()
    return row
