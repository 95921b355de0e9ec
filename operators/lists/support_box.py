"""Add Box Here: what carries the body where neither the floor nor the scene does."""

import bpy

from ...bridge.properties.settings import settings_of
from ...bridge.rows.choices import SurfaceRole
from ...bridge.scene.support_box import add_support_box
from ...solver.data.scene import SupportBox
from ..names import OperatorId
from ..operator_types import OperatorResult
from ..solve.common import FaultyOperator, chosen_armature, required_armature
from ..solve.session import session
from .surfaces import row_of

NOTHING_UNSEEN = "Press Analyze first; it tells where something unseen carries the body"
ADDED = "Added {}; press Analyze again"


def offered(armature: bpy.types.Object | None) -> tuple[SupportBox, ...]:
    """The boxes that would carry an armature's body, as its last analysis found."""
    support = session().support
    if armature is None or support is None or support[0] != armature.session_uid:
        return ()
    return support[1]


def sized(box: SupportBox) -> str:
    """A box's size in words."""
    return " × ".join(f"{side:.2f}" for side in box.size) + " m"


class AddSupportBoxOperator(FaultyOperator, bpy.types.Operator):
    bl_idname = OperatorId.ADD_SUPPORT_BOX
    bl_label = "Add Box Here"
    bl_description = (
        "Add a box under the feet, its top at their soles, as ground: what carried the performer "
        "where the recording shows nothing"
    )
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        return None if offered(chosen_armature(context)) else NOTHING_UNSEEN

    def run(self, context: bpy.types.Context) -> OperatorResult:
        armature = required_armature(context)
        boxes = offered(armature)
        for box in boxes:
            made = add_support_box(box)
            row = row_of(settings_of(armature), made)
            row.object, row.name, row.role = made, made.name, SurfaceRole.GROUND.name
        session().support = None
        self.report({"INFO"}, ADDED.format(" and ".join(sized(box) for box in boxes)))
        return {"FINISHED"}
