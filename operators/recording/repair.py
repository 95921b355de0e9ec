"""Repairs of a recording by its findings' remedies, and the way to where they are."""

import bpy

from ...bridge.accessors import armature_data, current_scene, pose_of
from ...bridge.properties.of_actions.shown_times import shown_frames
from ...bridge.properties.settings import HangtimeSettings, settings_of
from ...bridge.repairs.remedies import use_remedy
from ...bridge.repairs.stored import (
    finding_named,
    finding_of,
    findings,
    is_applied,
    repairs_in,
)
from ...bridge.rows.finding import HangtimeFinding
from ..names import OperatorId
from ..operator_types import OperatorResult, PolledOperator
from ..solve.common import chosen_armature, required_armature
from ..solve.live import redraw
from .examine import faults
from .remedies import MendingOperator

NOT_FOUND = "The recording has no finding “{}”; press Examine"
NO_REMEDY = "There is no remedy for this: look at the recording"
NOTHING = "There is nothing to repair; press Examine to look again"
ANALYZE = "; press Analyze next"


def has_remedy(row: HangtimeFinding) -> bool:
    """Whether there is something to be done about a finding."""
    return bool(row.remedy or row.mass)


def to_repair(settings: HangtimeSettings) -> list[HangtimeFinding]:
    """The findings whose remedy does not count yet, nor their other one."""
    return [
        row
        for row in findings(settings)
        if has_remedy(row) and not any(is_applied(settings, row, other=o) for o in (False, True))
    ]


class RepairOperator(MendingOperator, bpy.types.Operator):
    bl_idname = OperatorId.REPAIR
    bl_label = "Repair"
    bl_description = (
        "Apply this remedy, or leave it out again. The recording's keys are never changed: poses "
        "are mended when they are read, an empty above the armature turns and scales it, and "
        "missing frames are put into a copy"
    )
    bl_options = {"UNDO"}

    kind: bpy.props.StringProperty(options={"HIDDEN", "SKIP_SAVE"})
    other: bpy.props.BoolProperty(options={"HIDDEN", "SKIP_SAVE"})

    def mend(self, armature: bpy.types.Object) -> OperatorResult:
        settings = settings_of(armature)
        row = finding_named(settings, self.kind)
        if row is None:
            return self.refuse(NOT_FOUND.format(self.kind), "WARNING")
        if not has_remedy(row):
            return self.refuse(NO_REMEDY, "WARNING")
        used = is_applied(settings, row, other=self.other)
        use_remedy(armature, row, used=not used, other=self.other)
        return {"FINISHED"}


class RepairAllOperator(MendingOperator, bpy.types.Operator):
    bl_idname = OperatorId.REPAIR_ALL
    bl_label = "Repair All"
    bl_description = "Apply the remedy of everything that was found. Analyze next"
    bl_options = {"UNDO"}

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        why = super().obstacle(context)
        if why is None and not to_repair(settings_of(required_armature(context))):
            return NOTHING
        return why

    def mend(self, armature: bpy.types.Object) -> OperatorResult:
        rows = to_repair(settings_of(armature))
        rows.sort(key=lambda row: not repairs_in(row.remedy).missing)  # which may be refused
        for row in rows:
            use_remedy(armature, row, used=True)
        return self.done(f"Repaired {faults(len(rows))}{ANALYZE}")


class ShowFindingOperator(PolledOperator, bpy.types.Operator):
    bl_idname = OperatorId.SHOW_FINDING
    bl_label = "Show"
    bl_description = "Go to the next frame that this is about, and select the bone"
    bl_options = {"UNDO"}

    kind: bpy.props.StringProperty(options={"HIDDEN", "SKIP_SAVE"})

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        return None if chosen_armature(context) is not None else "Select the armature first"

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        armature = required_armature(context)
        settings = settings_of(armature)
        row = finding_named(settings, self.kind)
        if row is None:
            return self.refuse(NOT_FOUND.format(self.kind), "WARNING")
        finding = finding_of(row)
        starts = [shown_frames(armature)(first) for first, _ in finding.frames]
        if starts:
            now = current_scene().frame_current
            current_scene().frame_set(round(next((at for at in starts if at > now), starts[0])))
        select(armature, bone_of(settings, finding.part))
        redraw("VIEW_3D", "DOPESHEET_EDITOR")
        return {"FINISHED"}


def bone_of(settings: HangtimeSettings, part: str) -> str:
    """The bone that a finding is about: it is named, or the point of a contact is."""
    return next((row.bone for row in settings.contacts if row.point == part), part)


def select(armature: bpy.types.Object, bone: str) -> None:
    """Selects a bone alone, where the armature has it."""
    bones = armature_data(armature).bones
    if bone not in bones:
        return
    bones.active = bones[bone]
    for each in pose_of(armature).bones:  # since Blender 5.0 what is selected is the pose's
        owner = each if hasattr(each, "select") else each.bone
        owner.select = each.name == bone
