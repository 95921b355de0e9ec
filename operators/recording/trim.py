"""Trim: leave out the end of the frame range at which a recording cannot be held."""

import bpy

from ...bridge.properties.settings import settings_of
from ..names import OperatorId
from ..operator_types import OperatorResult, PolledOperator
from ..solve.common import hindrance, required_armature
from ..solve.session import session


class TrimOperator(PolledOperator, bpy.types.Operator):
    bl_idname = OperatorId.TRIM
    bl_label = "Trim"
    bl_description = "Make the frame range these frames, without what cannot be held. Analyze next"
    bl_options = {"REGISTER", "UNDO"}

    first: bpy.props.IntProperty(name="First")
    last: bpy.props.IntProperty(name="Last", default=1)

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        return hindrance(context)

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        if self.last <= self.first:
            return self.refuse(f"Frames {self.first} to {self.last} are no range")
        settings = settings_of(required_armature(context))
        settings.first_frame, settings.last_frame = self.first, self.last
        settings.use_range = True
        session().failure = None
        self.report({"INFO"}, f"The range is frames {self.first} to {self.last} now")
        return {"FINISHED"}
