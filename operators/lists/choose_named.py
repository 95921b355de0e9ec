"""From a failure to what it is about: the contact or constraint of that name, in its list."""

import bpy

from ...bridge.properties.constraint import HangtimeConstraint
from ...bridge.properties.contact import HangtimeContact
from ...bridge.properties.settings import HangtimeSettings, settings_of
from ..names import OperatorId
from ..operator_types import OperatorResult, PolledOperator, may_go_on_with
from ..solve.common import ReadyOperator, chosen_armature, required_armature
from ..solve.live import redraw

NO_ARMATURE = "Select the armature that carries the recording"
NOT_LISTED = "No contact and no constraint is called “{}” any more"


def named_row(settings: HangtimeSettings, name: str) -> HangtimeConstraint | HangtimeContact | None:
    """The constraint or contact of that name, which may be followed by that of its point."""
    name = name.partition(": ")[0]
    row: HangtimeConstraint | HangtimeContact | None = settings.constraints.get(name)
    return row if row is not None else settings.contacts.get(name)


def choose_named(settings: HangtimeSettings, name: str) -> bool:
    """Choose the constraint, the contact or the stance of that name, which may be followed by that
    of its point; whether there is one."""
    name = name.partition(": ")[0]
    constraint: int = settings.constraints.find(name)
    contact: int = settings.contacts.find(name)
    if contact < 0:
        phases = [row.phase for row in settings.contacts]
        contact = phases.index(name) if name in phases else -1
    if constraint >= 0:
        settings.active_constraint = constraint
    elif contact >= 0:
        settings.active_contact = contact
    return constraint >= 0 or contact >= 0


class ChooseNamedOperator(PolledOperator, bpy.types.Operator):
    bl_idname = OperatorId.CHOOSE_NAMED
    bl_label = "Choose"
    bl_description = "Choose what this is about in its list"
    bl_options = {"UNDO"}

    name: bpy.props.StringProperty(options={"HIDDEN", "SKIP_SAVE"})

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        return NO_ARMATURE if chosen_armature(context) is None else None

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        if not choose_named(settings_of(required_armature(context)), self.name):
            return self.refuse(NOT_LISTED.format(self.name), "WARNING")
        redraw("VIEW_3D")
        return {"FINISHED"}


class TickNamedOperator(ReadyOperator, bpy.types.Operator):
    bl_idname = OperatorId.TICK_NAMED
    bl_label = "Untick"
    bl_description = (
        "Leave this contact or constraint out of the next solve, as its tick in the list does; "
        "press again to let it count"
    )
    bl_options = {"UNDO"}

    name: bpy.props.StringProperty(options={"HIDDEN", "SKIP_SAVE"})
    # The operator that tries again afterwards; none where it is empty.
    then: bpy.props.StringProperty(options={"HIDDEN", "SKIP_SAVE"})

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        settings = settings_of(required_armature(context))
        row = named_row(settings, self.name)
        if row is None:
            return self.refuse(NOT_LISTED.format(self.name), "WARNING")
        if self.then and not may_go_on_with(self.then):
            return self.go_on_with(self.then)  # which says why not
        row.used = not row.used
        choose_named(settings, self.name)
        redraw("VIEW_3D")
        return self.go_on_with(self.then) if self.then else {"FINISHED"}
