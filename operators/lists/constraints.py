"""The list of constraints: add, remove, copy, move, aim at frames and place."""

import bpy

from ...bridge.accessors import pose_of, present
from ...bridge.constraint_kinds import KINDS, point
from ...bridge.constraints.rows import (
    add_constraint,
    copy_row,
    free_name,
    hold_during,
    hold_in,
    phase_at,
)
from ...bridge.properties.constraint import HangtimeConstraint
from ...bridge.properties.settings import settings_of
from ...bridge.rows.kind import BoneUse, NewRange
from ...bridge.rows.phases import phases_of
from ..names import OperatorId
from ..operator_types import OperatorResult
from ..solve.common import required_armature
from .row_lists import AddingOperator, RemoveOperator, RowOperator, chosen_bones

NOT_A_POINT = "Only a Point has a place"
NO_BONE = "Choose the point's bone first"
NO_PREVIEW = "Set a preview range in the timeline first"
NO_PHASE = "No phase is known at this frame; press Analyze first"


class AddConstraintOperator(AddingOperator, bpy.types.Operator):
    bl_idname = OperatorId.ADD_CONSTRAINT
    bl_label = "Add Constraint"
    bl_description = "Add a constraint about the selected pose bones and the current frame"

    kind: bpy.props.EnumProperty(
        name="Kind", items=[(kind.name, kind.label, kind.description) for kind in KINDS.values()]
    )

    @classmethod
    def description(
        cls, _context: bpy.types.Context, properties: bpy.types.OperatorProperties
    ) -> str:
        return KINDS[properties.kind].description

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        armature, kind = required_armature(context), KINDS[self.kind]
        bones = chosen_bones(armature)
        frame = present(context.scene).frame_current_final
        groups = [[bone] for bone in bones] if kind.bones is BoneUse.ONE and bones else [bones]
        for group in groups:
            add_constraint(armature, kind, group, frame)
        return {"FINISHED"}


class RemoveConstraintOperator(RemoveOperator, bpy.types.Operator):
    bl_idname = OperatorId.REMOVE_CONSTRAINT
    bl_label = "Remove Constraint"
    bl_description = "Delete the chosen constraint"


class CopyConstraintOperator(RowOperator, bpy.types.Operator):
    bl_idname = OperatorId.COPY_CONSTRAINT
    bl_label = "Duplicate Constraint"
    bl_description = "Add a copy of the chosen constraint"

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        settings = settings_of(required_armature(context))
        source = self.of.chosen(settings)
        copy = settings.constraints.add()  # may move the others in memory: look rows up after it
        row = settings.constraints[source]
        copy.name = free_name(settings, row.name)
        copy_row(row, copy)
        self.of.choose(settings, len(settings.constraints) - 1)
        return {"FINISHED"}


class MoveConstraintOperator(RowOperator, bpy.types.Operator):
    bl_idname = OperatorId.MOVE_CONSTRAINT
    bl_label = "Move Constraint"
    bl_description = "Move the chosen constraint in the list"
    own = True

    direction: bpy.props.EnumProperty(
        name="Direction", items=[("UP", "Up", ""), ("DOWN", "Down", "")]
    )

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        armature = required_armature(context)
        settings = settings_of(armature)
        index = self.of.chosen(settings)
        to = index + (-1 if self.direction == "UP" else 1)
        if not self.of.linked(armature) <= to < len(settings.constraints):
            return {"CANCELLED"}
        settings.constraints.move(index, to)
        self.of.choose(settings, to)
        return {"FINISHED"}


class SetRangeOperator(RowOperator, bpy.types.Operator):
    bl_idname = OperatorId.SET_CONSTRAINT_RANGE
    bl_label = "Set Range"
    bl_description = "Choose when the chosen constraint holds"

    to: bpy.props.EnumProperty(
        name="To",
        items=[
            ("FRAME", "Current Frame", "The frame at the playhead alone"),
            ("PHASE", "Current Phase", "The phase of the clip at the playhead"),
            ("PREVIEW", "Preview Range", "The preview range of the timeline"),
        ],
    )

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        scene, row = present(context.scene), self.row(context)
        kind, why = KINDS[row.kind], None
        if self.to == "PHASE":
            why = self._set_phase(context, row)
        elif kind.range is NewRange.PHASE_ALWAYS:
            why = f"A {kind.label} holds in a phase; choose one"
        elif self.to == "PREVIEW" and not scene.use_preview_range:
            why = NO_PREVIEW
        elif self.to == "PREVIEW":
            hold_during(row, scene.frame_preview_start, scene.frame_preview_end)
        else:
            hold_during(row, scene.frame_current_final, scene.frame_current_final)
        return {"FINISHED"} if why is None else self.refuse(why, "WARNING")

    def _set_phase(self, context: bpy.types.Context, row: HangtimeConstraint) -> str | None:
        """Why not; None where done."""
        settings = settings_of(required_armature(context))
        phase = phase_at(phases_of(settings), present(context.scene).frame_current_final)
        if phase is None:
            return NO_PHASE
        hold_in(row, phase.name)
        return None


class PlaceConstraintOperator(RowOperator, bpy.types.Operator):
    bl_idname = OperatorId.PLACE_CONSTRAINT
    bl_label = "Place Where Shown"
    bl_description = "Put the point where its bone is shown at the current frame"

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        armature, row = required_armature(context), self.row(context)
        why = None
        if row.kind != point.KIND.name:
            why = NOT_A_POINT
        elif not row.bones or row.bones[0].name not in pose_of(armature).bones:
            why = NO_BONE
        if why is not None:
            return self.refuse(why, "WARNING")
        point.put_where_shown(armature, row, keep_offset=True)
        return {"FINISHED"}
