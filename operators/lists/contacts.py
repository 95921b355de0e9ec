"""The list of contacts: add what the analysis has missed, remove, place, and put back."""

import bpy
import numpy as np

from ...bridge.accessors import current_scene, present
from ...bridge.armature.poses import metres_per_unit
from ...bridge.armature.traces_store import kept
from ...bridge.properties.overridden_lists import linked_count
from ...bridge.properties.settings import scene_settings, settings_of
from ...bridge.properties.stances import active_contact, active_stance, join, may_mark, put_back
from ...bridge.rows.protocols import ContactRow
from ..names import OperatorId
from ..operator_types import OperatorResult, PolledOperator
from ..solve.common import chosen_armature, required_armature

USUAL_FRAMES = 10
EMPTY_SIZE = 0.05  # m
NO_CONTACT = "Choose a contact in the list first"
NO_POINTS_KNOWN = "Press Analyze first, to know what may touch"


def _points(
    _operator: bpy.types.Operator, context: bpy.types.Context
) -> list[tuple[str, str, str]]:
    seen = kept(chosen_armature(context)) if context is not None else None
    return [(name, name, "") for name in seen.traces.contacts] if seen is not None else []


class AddContactOperator(PolledOperator, bpy.types.Operator):
    bl_idname = OperatorId.ADD_CONTACT
    bl_label = "Add Contact"
    bl_description = (
        "Let a heel, toe, hand or knee touch from the current frame on, where it was recorded, or "
        "where its stance was moved to; adjust its frames"
    )
    bl_options = {"REGISTER", "UNDO"}
    bl_property = "point"

    point: bpy.props.EnumProperty(name="Point", items=_points)

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        return NO_POINTS_KNOWN if kept(chosen_armature(context)) is None else None

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> OperatorResult:
        present(context.window_manager).invoke_search_popup(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        frame = float(present(context.scene).frame_current)
        add_contact(required_armature(context), self.point, frame, frame + USUAL_FRAMES)
        return {"FINISHED"}


def add_contact(armature: bpy.types.Object, point: str, first: float, last: float) -> None:
    """A new row of a point that the analysis knows, chosen; it touches from frame to frame, as far
    as these are recorded, where it was then, or where its stance was moved to."""
    settings, traces = settings_of(armature), present(kept(armature)).traces
    first, last = (float(np.clip(each, *traces.frames[[0, -1]])) for each in (first, last))
    during = (traces.frames >= first) & (traces.frames <= last)
    row = settings.contacts.add()
    row.name, row.point, row.added = f"{point} added", point, True
    alike = [c for c in settings.contacts if c.point == point and not c.added]
    row.bone = alike[0].bone if alike else ""
    row.found_start = row.start_frame = first
    row.found_end = row.end_frame = last
    metre = 1.0 / metres_per_unit(current_scene())
    place = traces.points[during, traces.contacts.index(point)].mean(axis=0)
    row.found_at = row.at = metre * place
    near = [c for c in settings.contacts if c.start_frame <= last and c.end_frame >= first]
    row.phase = next((c.phase for c in near if c.phase), "")
    join(settings, row, metre)
    settings.active_contact = len(settings.contacts) - 1


class _OfContact(PolledOperator):
    """Mixin: an operator on the chosen contact."""

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        armature = chosen_armature(context)
        found = armature is not None and active_contact(settings_of(armature)) is not None
        return None if found else NO_CONTACT


class RemoveContactOperator(_OfContact, bpy.types.Operator):
    bl_idname = OperatorId.REMOVE_CONTACT
    bl_label = "Remove Contact"
    bl_description = (
        "Delete a contact that was added; one that was found is switched off, so that it can be "
        "switched on again"
    )
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        armature = required_armature(context)
        settings = settings_of(armature)
        row, linked = present(active_contact(settings)), linked_count(armature, "contacts")
        if row.added and settings.active_contact >= linked:
            settings.contacts.remove(settings.active_contact)
            settings.active_contact = min(settings.active_contact, len(settings.contacts) - 1)
        else:
            row.used = False
        return {"FINISHED"}


class PlaceByEmptyOperator(_OfContact, bpy.types.Operator):
    bl_idname = OperatorId.PLACE_BY_EMPTY
    bl_label = "Place by Empty"
    bl_description = "Add an empty at the contact's place; where you move it, the point shall touch"
    bl_options = {"UNDO"}

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        armature, layer = required_armature(context), present(context.view_layer)
        row = present(active_contact(settings_of(armature)))
        there = row.empty is not None and row.empty.name in layer.objects
        if not (there and may_mark(row.empty, armature)):
            row.empty = _new_empty(context, row)
            settings_of(row.empty).marks = armature
        if context.mode == "OBJECT":
            bpy.ops.object.select_all(action="DESELECT")
            row.empty.select_set(True)
            layer.objects.active = row.empty
        # The choice in the sidebar outlives that the empty is active now.
        scene_settings(context.scene).armature = armature
        return {"FINISHED"}


class PutBackOperator(PolledOperator, bpy.types.Operator):
    bl_idname = OperatorId.PUT_BACK
    bl_label = "Put Back"
    bl_description = "Put every contact of the chosen phase where it was recorded"
    bl_options = {"UNDO"}

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        armature = chosen_armature(context)
        found = armature is not None and active_stance(settings_of(armature)) is not None
        return None if found else NO_CONTACT

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        settings = settings_of(required_armature(context))
        put_back(settings, present(active_stance(settings)))
        return {"FINISHED"}


def _new_empty(context: bpy.types.Context, row: ContactRow) -> bpy.types.Object:
    empty = bpy.data.objects.new(row.name, None)
    empty.empty_display_type = "SPHERE"
    empty.empty_display_size = EMPTY_SIZE / metres_per_unit(present(context.scene))
    empty.location = row.at
    present(context.collection).objects.link(empty)
    present(context.view_layer).update()  # so that its world matrix is where it is
    return empty
