"""Show Recording and Show Adapted: the armature performs the one action or the other."""

from __future__ import annotations

import bpy

from ...bridge.accessors import current_action
from ...bridge.armature.actions import recorded_action, show
from ..names import OperatorId
from .common import chosen_armature


class ShowRecordingOperator(bpy.types.Operator):
    bl_idname = OperatorId.SHOW_RECORDING
    bl_label = "Show Recording"
    bl_description = "Go back to the recording's action; the adapted one is kept"
    bl_options = {"UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        armature = chosen_armature(context)
        if armature is None or current_action(armature) == recorded_action(armature):
            cls.poll_message_set("The recording is what is shown")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        armature = chosen_armature(context)
        show(armature, recorded_action(armature))
        return {"FINISHED"}


class ShowAdaptedOperator(bpy.types.Operator):
    bl_idname = OperatorId.SHOW_ADAPTED
    bl_label = "Show Adapted"
    bl_description = "Go to the action that was adapted last"
    bl_options = {"UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        armature = chosen_armature(context)
        if armature is None or armature.hangtime.adapted is None:
            cls.poll_message_set("Nothing has been adapted yet")
            return False
        if current_action(armature) == armature.hangtime.adapted:
            cls.poll_message_set("The adapted motion is what is shown")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        armature = chosen_armature(context)
        show(armature, armature.hangtime.adapted)
        return {"FINISHED"}


CLASSES = (ShowRecordingOperator, ShowAdaptedOperator)
