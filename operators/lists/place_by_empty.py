"""Place by Empty: an empty in the viewport that carries a contact's place."""

from __future__ import annotations

import bpy

from ...bridge.accessors import present
from ...bridge.armature.poses import metres_per_unit
from ...bridge.properties.settings import scene_settings, settings_of
from ...bridge.properties.stances import active_contact
from ...bridge.rows.protocols import ContactRow
from ..names import OperatorId
from ..operator_types import OperatorResult
from ..solve.common import chosen_armature, required_armature

SIZE = 0.05  # m
NO_CONTACT = "Choose a contact in the list first"


class PlaceByEmptyOperator(bpy.types.Operator):
    bl_idname = OperatorId.PLACE_BY_EMPTY
    bl_label = "Place by Empty"
    bl_description = "Add an empty at the contact's place; where you move it, the point shall touch"
    bl_options = {"UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        armature = chosen_armature(context)
        possible = armature is not None and active_contact(settings_of(armature)) is not None
        if not possible:
            cls.poll_message_set(NO_CONTACT)
        return possible

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        armature, layer = required_armature(context), present(context.view_layer)
        row = present(active_contact(settings_of(armature)))
        if row.empty is None or row.empty.name not in layer.objects:
            row.empty = _new_empty(context, row)
            settings_of(row.empty).marks = armature
        if context.mode == "OBJECT":
            bpy.ops.object.select_all(action="DESELECT")
            row.empty.select_set(True)
            layer.objects.active = row.empty
        # The choice in the sidebar outlives that the empty is active now.
        scene_settings(context.scene).armature = armature
        return {"FINISHED"}


def _new_empty(context: bpy.types.Context, row: ContactRow) -> bpy.types.Object:
    empty = bpy.data.objects.new(row.name, None)
    empty.empty_display_type = "SPHERE"
    empty.empty_display_size = SIZE / metres_per_unit(present(context.scene))
    empty.location = row.at
    present(context.collection).objects.link(empty)
    present(context.view_layer).update()  # so that its world matrix is where it is
    return empty


CLASSES = (PlaceByEmptyOperator,)
