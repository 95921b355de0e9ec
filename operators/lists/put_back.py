"""Put Back: the chosen stance where it was recorded."""

from __future__ import annotations

import bpy

from ...bridge.properties.stances import active_stance, put_back
from ..names import OperatorId
from ..solve.common import chosen_armature
from .place_by_empty import NO_CONTACT


class PutBackOperator(bpy.types.Operator):
    bl_idname = OperatorId.PUT_BACK
    bl_label = "Put Back"
    bl_description = "Put every contact of the chosen phase where it was recorded"
    bl_options = {"UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        armature = chosen_armature(context)
        possible = armature is not None and active_stance(armature.hangtime) is not None
        if not possible:
            cls.poll_message_set(NO_CONTACT)
        return possible

    def execute(self, context: bpy.types.Context) -> set[str]:
        settings = chosen_armature(context).hangtime
        put_back(settings, active_stance(settings))
        return {"FINISHED"}


CLASSES = (PutBackOperator,)
