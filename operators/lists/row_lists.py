"""What the operators on the lists of constraints, of body changes and of surfaces share."""

from __future__ import annotations

from enum import Enum
from typing import Any

import bpy

from ...bridge.accessors import armature_data, pose_of
from ...bridge.properties.constraint import HangtimeConstraint
from ...bridge.properties.overridden_lists import linked_count
from ...bridge.properties.settings import HangtimeSettings, settings_of
from ..operator_types import OperatorResult, PolledOperator
from ..solve.common import LINKED, chosen_armature, required_armature

NO_ARMATURE = "Select the armature that carries the recording"
NO_CONSTRAINT = "Choose a constraint in the list first"
NO_BODY_CHANGE = "Choose a weight, a limb or a shape in the list first"
NO_SURFACE = "Choose a surface in the list first"
NONE_SELECTED = "Select bones in pose mode first"
FROM_LIBRARY = "It comes from the linked file; switch it off instead, and add one of your own"


class RowList(Enum):
    """Which list, by the names of the settings' properties: the rows, and the chosen one."""

    CONSTRAINTS = ("constraints", "active_constraint", NO_CONSTRAINT)
    BODY_CHANGES = ("body_changes", "active_body_change", NO_BODY_CHANGE)
    SURFACES = ("surfaces", "active_surface", NO_SURFACE)

    def rows(self, settings: HangtimeSettings) -> bpy.types.bpy_prop_collection_idprop[Any]:
        rows: bpy.types.bpy_prop_collection_idprop[Any] = getattr(settings, self.value[0])
        return rows

    def chosen(self, settings: HangtimeSettings) -> int:
        """The index of the chosen row, -1 where there is none."""
        index = int(getattr(settings, self.value[1]))
        return index if 0 <= index < len(self.rows(settings)) else -1

    def choose(self, settings: HangtimeSettings, index: int) -> None:
        setattr(settings, self.value[1], max(min(index, len(self.rows(settings)) - 1), 0))

    def linked(self, armature: bpy.types.Object) -> int:
        """How many rows, the first ones, come from the file that an override overrides."""
        return linked_count(armature, self.value[0])

    @property
    def nothing_chosen(self) -> str:
        return str(self.value[2])

    @property
    def label(self) -> str:
        return self.name.replace("_", " ").title()


def chosen_bones(armature: bpy.types.Object) -> list[str]:
    """Names of the selected pose bones, the active one first; none outside pose mode."""
    if armature.mode != "POSE":
        return []
    names = [bone.name for bone in pose_of(armature).bones if is_selected(bone)]
    active = armature_data(armature).bones.active
    if active is not None and active.name in names:
        names.remove(active.name)
        names.insert(0, active.name)
    return names


def is_selected(bone: bpy.types.PoseBone) -> bool:
    """Whether a pose bone is selected and seen."""
    # From Blender 5.0 on the pose's bone knows it.
    carrier = bone if hasattr(bone, "select") else bone.bone
    return bool(carrier.select and not getattr(carrier, "hide", False))


class AddingOperator(PolledOperator):
    """Mixin: an operator that may run wherever an armature is chosen that can be changed."""

    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        armature = chosen_armature(context)
        if armature is None or armature.type != "ARMATURE":
            return NO_ARMATURE
        return None if armature.is_editable else LINKED


class SelectedBonesOperator(AddingOperator):
    """Mixin: an operator about selected pose bones."""

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        why = super().obstacle(context)
        if why is None and not chosen_bones(required_armature(context)):
            return NONE_SELECTED
        return why


class RowOperator(AddingOperator):
    """Mixin: an operator on the chosen row of `of`. own: whether rows of a library are refused."""

    of = RowList.CONSTRAINTS
    own = False

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        why = super().obstacle(context)
        if why is not None:
            return why
        armature = required_armature(context)
        index = cls.of.chosen(settings_of(armature))
        if index < 0:
            return cls.of.nothing_chosen
        return FROM_LIBRARY if cls.own and index < cls.of.linked(armature) else None

    def row(self, context: bpy.types.Context) -> HangtimeConstraint:
        """The chosen row."""
        settings = settings_of(required_armature(context))
        row: HangtimeConstraint = self.of.rows(settings)[self.of.chosen(settings)]
        return row


class RemoveOperator(RowOperator):
    """Mixin: deletes the chosen row."""

    own = True

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        settings = settings_of(required_armature(context))
        index = self.of.chosen(settings)
        self.of.rows(settings).remove(index)
        self.of.choose(settings, index)
        return {"FINISHED"}
