"""What would carry the body where neither the floor, the scene nor a contact does: boxes under the
feet, contacts of hands and feet, and points at which hands hold on, as the analysis offers them."""

from dataclasses import replace

import bpy

from ...bridge.constraint_kinds.point import KIND as POINT
from ...bridge.constraints.rows import add_constraint, free_name, hold_during
from ...bridge.properties.settings import settings_of
from ...bridge.rows.choices import SurfaceRole
from ...bridge.scene.support_box import add_support_box
from ...solver.data.requests import PointRequest
from ...solver.data.scene import SupportBox
from ...solver.unseen.offered import OfferedSupport
from ..names import OperatorId
from ..operator_types import OperatorResult
from ..solve.common import FaultyOperator, chosen_armature, required_armature
from ..solve.session import session
from .contacts import add_contact
from .surfaces import row_of

NOTHING_UNSEEN = "Press Analyze first; it tells where something unseen carries the body"
ADDED = "Added {}; press Analyze again"


def offered(armature: bpy.types.Object | None) -> OfferedSupport:
    """What would carry an armature's body, as its last analysis found."""
    support = session().support
    if armature is None or support is None or support[0] != armature.session_uid:
        return OfferedSupport()
    return support[1]


def sized(box: SupportBox) -> str:
    """A box's size in words."""
    return " × ".join(f"{side:.2f}" for side in box.size) + " m"


class _OfOffer(FaultyOperator):
    """Mixin: an operator that adds what is offered. of: the field of the offer."""

    bl_options = {"REGISTER", "UNDO"}
    of = ""

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        return None if getattr(offered(chosen_armature(context)), cls.of) else NOTHING_UNSEEN


class AddSupportBoxOperator(_OfOffer, bpy.types.Operator):
    bl_idname = OperatorId.ADD_SUPPORT_BOX
    bl_label = "Add Box Here"
    bl_description = (
        "Add a box under the feet, its top at their soles, as ground: what carried the performer "
        "where the recording shows nothing"
    )
    of = "boxes"

    def run(self, context: bpy.types.Context) -> OperatorResult:
        armature = required_armature(context)
        offer = offered(armature)
        for box in offer.boxes:
            made = add_support_box(box)
            row = row_of(settings_of(armature), made)
            row.object, row.name, row.role = made, made.name, SurfaceRole.GROUND.name
        session().support = (armature.session_uid, replace(offer, boxes=()))
        self.report({"INFO"}, ADDED.format(" and ".join(sized(box) for box in offer.boxes)))
        return {"FINISHED"}


class AddOfferedContactsOperator(_OfOffer, bpy.types.Operator):
    bl_idname = OperatorId.ADD_OFFERED_CONTACTS
    bl_label = "Let Them Touch"
    bl_description = (
        "Add contacts of the hands on the floor, or of the feet on a wall, in the frames in which "
        "they rest there while something unseen carries the body"
    )
    of = "contacts"

    def run(self, context: bpy.types.Context) -> OperatorResult:
        armature = required_armature(context)
        offer = offered(armature)
        for each in offer.contacts:
            add_contact(armature, each.point, each.start_frame, each.end_frame)
        session().support = (armature.session_uid, replace(offer, contacts=()))
        self.report({"INFO"}, ADDED.format(", ".join(each.point for each in offer.contacts)))
        return {"FINISHED"}


class AddHoldsOperator(_OfOffer, bpy.types.Operator):
    bl_idname = OperatorId.ADD_HOLDS
    bl_label = "Hold On Here"
    bl_description = (
        "Add a Point with Pushes Back and Grip to each hand, in the frames in which it holds on to "
        "something that the recording does not show"
    )
    of = "holds"

    def run(self, context: bpy.types.Context) -> OperatorResult:
        armature = required_armature(context)
        offer = offered(armature)
        names = [_add_hold(armature, each) for each in offer.holds]
        session().support = (armature.session_uid, replace(offer, holds=()))
        self.report({"INFO"}, f"Added {', '.join(names)}")
        return {"FINISHED"}


def _add_hold(armature: bpy.types.Object, hold: PointRequest) -> str:
    """A Point where the recording has it, of the hand's joint or of its middle; its name."""
    assert hold.when.frames is not None
    first, last = hold.when.frames
    row = add_constraint(armature, POINT, [hold.bone], first)
    row.name = free_name(settings_of(armature), hold.name)
    hold_during(row, first, last)
    row.use_place, row.environment, row.grip = False, hold.environment, hold.grip
    row.use_offset = hold.offset is not None
    row.offset = hold.offset or (0.0, 0.0, 0.0)
    return str(row.name)
