"""The list of body changes: add and remove weights, limbs, shapes; and the bones of either list."""

import bpy

from ...bridge.constraint_kinds import KINDS
from ...bridge.constraints.rows import add_body_change, set_bones
from ...bridge.properties.body_change import HangtimeBodyChange
from ...bridge.properties.constraint import HangtimeConstraint
from ...bridge.properties.settings import settings_of
from ...bridge.rows.choices import BodyKind
from ...bridge.rows.kind import BoneUse
from ..names import OperatorId
from ..operator_types import OperatorResult
from ..solve.common import required_armature
from .row_lists import (
    FROM_LIBRARY,
    AddingOperator,
    RemoveOperator,
    RowList,
    SelectedBonesOperator,
    chosen_bones,
)

_OF_ONE_BONE = {
    BodyKind.LOAD.name,
    *(kind.name for kind in KINDS.values() if kind.bones is BoneUse.ONE),
}
DESCRIPTIONS = {
    BodyKind.LOAD: "Let a bone carry a weight, such as a bag in a hand",
    BodyKind.LIMB: "Make bones longer or shorter, heavier or lighter",
    BodyKind.SHAPE: "Say what bones go through, how thick they are and how far their joints go",
}
_BONED = (RowList.CONSTRAINTS, RowList.BODY_CHANGES)  # lists whose rows are about bones
BonedRow = HangtimeConstraint | HangtimeBodyChange
KIND_ITEMS = [(kind.name, kind.value, DESCRIPTIONS[kind]) for kind in BodyKind]
NO_SUCH_BONE = "“{}” has {} fields of bones, counted from 0, and none with the number {}"


class AddBodyChangeOperator(AddingOperator, bpy.types.Operator):
    bl_idname = OperatorId.ADD_BODY_CHANGE
    bl_label = "Add Body Change"
    bl_description = "Add a weight, a limb or a shape of the selected pose bones"

    kind: bpy.props.EnumProperty(name="Kind", items=KIND_ITEMS)

    @classmethod
    def description(
        cls, _context: bpy.types.Context, properties: bpy.types.OperatorProperties
    ) -> str:
        return DESCRIPTIONS[BodyKind[properties.kind]]

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        armature, kind = required_armature(context), BodyKind[self.kind]
        bones = chosen_bones(armature)
        groups = [[bone] for bone in bones] if kind is BodyKind.LOAD and bones else [bones]
        for group in groups:
            add_body_change(settings_of(armature), kind, group)
        return {"FINISHED"}


class RemoveBodyChangeOperator(RemoveOperator, bpy.types.Operator):
    bl_idname = OperatorId.REMOVE_BODY_CHANGE
    bl_label = "Remove Body Change"
    bl_description = "Delete the chosen weight, limb or shape"
    of = RowList.BODY_CHANGES


class _BonesOperator(AddingOperator):
    """Mixin: changes the bones of the chosen row of either list."""

    of: bpy.props.EnumProperty(name="List", items=[(each.name, each.label, "") for each in _BONED])

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        armature, of = required_armature(context), RowList[self.of]
        index = of.chosen(settings_of(armature))
        if index < of.linked(armature):
            return self.refuse(of.nothing_chosen if index < 0 else FROM_LIBRARY, "WARNING")
        row = of.rows(settings_of(armature))[index]
        why = self.change(row, armature)
        return {"FINISHED"} if why is None else self.refuse(why, "WARNING")

    def change(self, row: BonedRow, armature: bpy.types.Object) -> str | None:
        """Changes the bones of a row; why not, None where done."""
        raise NotImplementedError


class AssignBonesOperator(_BonesOperator, SelectedBonesOperator, bpy.types.Operator):
    bl_idname = OperatorId.ASSIGN_BONES
    bl_label = "Assign Selected Bones"
    bl_description = "Let the chosen row be about the bones that are selected in pose mode"

    def change(self, row: BonedRow, armature: bpy.types.Object) -> str | None:
        bones = chosen_bones(armature)
        set_bones(row, bones[:1] if row.kind in _OF_ONE_BONE else bones)
        return None


class AddBoneOperator(_BonesOperator, bpy.types.Operator):
    bl_idname = OperatorId.ADD_BONE
    bl_label = "Add Bone"
    bl_description = "Add a field to choose one more bone in"

    def change(self, row: BonedRow, _armature: bpy.types.Object) -> str | None:
        row.bones.add()
        return None


class RemoveBoneOperator(_BonesOperator, bpy.types.Operator):
    bl_idname = OperatorId.REMOVE_BONE
    bl_label = "Remove Bone"
    bl_description = "Take this bone off the chosen row"

    index: bpy.props.IntProperty(name="Index", min=0)

    def change(self, row: BonedRow, _armature: bpy.types.Object) -> str | None:
        if self.index >= len(row.bones):
            return NO_SUCH_BONE.format(row.name, len(row.bones), self.index)
        row.bones.remove(self.index)
        return None
