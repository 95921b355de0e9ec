"""Remedies of a recording whose fall or height is nobody's: the scene's frame rate, the scale."""

import bpy

from ...bridge.accessors import present
from ...bridge.armature.actions import recorded_action
from ...bridge.files.object_scale import scale_object
from ..names import OperatorId
from ..operator_types import OperatorResult, PolledOperator
from ..solve.common import hindrance, required_armature
from ..solve.session import session


class SetFrameRateOperator(PolledOperator, bpy.types.Operator):
    bl_idname = OperatorId.SET_FRAME_RATE
    bl_label = "Set Frame Rate"
    bl_description = (
        "Play the scene at the frame rate at which the body falls as gravity has it; keys stay at "
        "their frames. Analyze again next"
    )
    bl_options = {"REGISTER", "UNDO"}

    rate: bpy.props.IntProperty(name="Frame Rate", default=24, min=1, max=1000)

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        return hindrance(context)

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        render = present(context.scene).render
        render.fps, render.fps_base = self.rate, 1.0
        session().failure = None
        self.report({"INFO"}, f"The scene has {self.rate} frames a second now")
        return {"FINISHED"}


class ScaleToHumanOperator(PolledOperator, bpy.types.Operator):
    bl_idname = OperatorId.SCALE_TO_HUMAN
    bl_label = "Scale to Human Size"
    bl_description = (
        "Scale the armature's object, and its keys of scale and location where an importer made "
        "some, to a person's height. Analyze again next"
    )
    bl_options = {"REGISTER", "UNDO"}

    factor: bpy.props.FloatProperty(name="Factor", default=1.0, min=1e-6)

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        return hindrance(context)

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        armature = required_armature(context)
        scale_object(armature, recorded_action(armature), self.factor)
        session().failure = None
        self.report({"INFO"}, f"{armature.name} is {self.factor:.3g} times as large now")
        return {"FINISHED"}
