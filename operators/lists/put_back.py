"""Put Back: the chosen stance where it was recorded."""

from __future__ import annotations

import bpy

from ...bridge.accessors import present
from ...bridge.properties.settings import settings_of
from ...bridge.properties.stances import active_stance, put_back
from ..names import OperatorId
from ..operator_types import OperatorResult
from ..solve.common import chosen_armature, required_armature
from .place_by_empty import NO_CONTACT


class PutBackOperator(bpy.types.Operator):
    bl_idname = OperatorId.PUT_BACK
    bl_label = "Put Back"
    bl_description = "Put every contact of the chosen phase where it was recorded"
    bl_options = {"UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        armature = chosen_armature(context)
        possible = armature is not None and active_stance(settings_of(armature)) is not None
        if not possible:
            cls.poll_message_set(NO_CONTACT)
        return possible

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        settings = settings_of(required_armature(context))
        put_back(settings, present(active_stance(settings)))
        return {"FINISHED"}


CLASSES = (PutBackOperator,)
