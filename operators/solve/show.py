"""Show Recording and Show Adapted: the armature performs the one action or the other."""

from __future__ import annotations

import bpy

from ...bridge.accessors import current_action, present
from ...bridge.armature.actions import recorded_action, show
from ...bridge.properties.settings import settings_of
from ..names import OperatorId
from ..operator_types import OperatorResult
from .common import chosen_armature, required_armature
from .results import NOTHING_ADAPTED


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

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        armature = required_armature(context)
        show(armature, present(recorded_action(armature)))
        return {"FINISHED"}


class ShowAdaptedOperator(bpy.types.Operator):
    bl_idname = OperatorId.SHOW_ADAPTED
    bl_label = "Show Adapted"
    bl_description = "Go to the action that was adapted last"
    bl_options = {"UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        armature = chosen_armature(context)
        if armature is None or settings_of(armature).adapted is None:
            cls.poll_message_set(NOTHING_ADAPTED)
            return False
        if current_action(armature) == settings_of(armature).adapted:
            cls.poll_message_set("The adapted motion is what is shown")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        armature = required_armature(context)
        show(armature, settings_of(armature).adapted)
        return {"FINISHED"}


CLASSES = (ShowRecordingOperator, ShowAdaptedOperator)
