"""Add and Remove Contact: what the analysis has missed, or has seen where nothing touches."""

from __future__ import annotations

import bpy
import numpy as np

from ...bridge.accessors import present
from ...bridge.armature.poses import metres_per_unit
from ...bridge.armature.traces_store import kept
from ...bridge.properties.settings import settings_of
from ...bridge.properties.stances import active_contact
from ..names import OperatorId
from ..operator_types import OperatorResult
from ..solve.common import chosen_armature, required_armature
from .place_by_empty import NO_CONTACT

USUAL_FRAMES = 10
NO_POINTS_KNOWN = "Press Analyze first, to know what may touch"


def _points(
    _operator: bpy.types.Operator, context: bpy.types.Context
) -> list[tuple[str, str, str]]:
    seen = kept(chosen_armature(context)) if context is not None else None
    return [(name, name, "") for name in seen.traces.contacts] if seen is not None else []


class AddContactOperator(bpy.types.Operator):
    bl_idname = OperatorId.ADD_CONTACT
    bl_label = "Add Contact"
    bl_description = "Let a heel, toe or hand touch from the current frame on; adjust its frames"
    bl_options = {"REGISTER", "UNDO"}
    bl_property = "point"

    point: bpy.props.EnumProperty(name="Point", items=_points)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        armature = chosen_armature(context)
        if armature is None or kept(armature) is None:
            cls.poll_message_set(NO_POINTS_KNOWN)
            return False
        return True

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> OperatorResult:
        present(context.window_manager).invoke_search_popup(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        armature, scene = required_armature(context), present(context.scene)
        settings, traces = settings_of(armature), present(kept(armature)).traces
        column = traces.contacts.index(self.point)
        first = float(np.clip(scene.frame_current, *traces.frames[[0, -1]]))
        last = min(first + USUAL_FRAMES, float(traces.frames[-1]))
        during = (traces.frames >= first) & (traces.frames <= last)
        row = settings.contacts.add()
        row.name, row.point, row.added = f"{self.point} added", self.point, True
        alike = [c for c in settings.contacts if c.point == self.point and not c.added]
        row.bone = alike[0].bone if alike else ""
        row.found_start = row.start_frame = first
        row.found_end = row.end_frame = last
        place = traces.points[during, column].mean(axis=0) / metres_per_unit(scene)
        row.found_at = row.at = place
        near = [c for c in settings.contacts if c.start_frame <= last and c.end_frame >= first]
        row.phase = next((c.phase for c in near if c.phase), "")
        settings.active_contact = len(settings.contacts) - 1
        return {"FINISHED"}


class RemoveContactOperator(bpy.types.Operator):
    bl_idname = OperatorId.REMOVE_CONTACT
    bl_label = "Remove Contact"
    bl_description = (
        "Delete a contact that was added; one that was found is switched off, so that it can be "
        "switched on again"
    )
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        armature = chosen_armature(context)
        possible = armature is not None and active_contact(settings_of(armature)) is not None
        if not possible:
            cls.poll_message_set(NO_CONTACT)
        return possible

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        settings = settings_of(required_armature(context))
        row = present(active_contact(settings))
        if row.added:
            settings.contacts.remove(settings.active_contact)
            settings.active_contact = min(settings.active_contact, len(settings.contacts) - 1)
        else:
            row.used = False
        return {"FINISHED"}


CLASSES = (AddContactOperator, RemoveContactOperator)
