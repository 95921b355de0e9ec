"""What the operators on the lists of constraints and of body changes share."""

from __future__ import annotations

from enum import Enum
from typing import Any

import bpy

from ...bridge.constraints.linked_rows import linked_count
from ...bridge.properties.constraint import HangtimeConstraint
from ...bridge.properties.settings import HangtimeSettings, settings_of
from ..operator_types import OperatorMixin
from ..solve.common import chosen_armature, required_armature

NO_ARMATURE = "Select the armature that carries the recording"
LINKED = "The armature is linked; make a library override of it first"
NO_CONSTRAINT = "Choose a constraint in the list first"
NO_BODY_CHANGE = "Choose a weight or a limb in the list first"
FROM_LIBRARY = "It comes from the linked file; switch it off instead, and add one of your own"


class RowList(Enum):
    """Which list, by the names of the settings' properties: the rows, and the chosen one."""

    CONSTRAINTS = ("constraints", "active_constraint", NO_CONSTRAINT)
    BODY_CHANGES = ("body_changes", "active_body_change", NO_BODY_CHANGE)

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


def list_items() -> list[tuple[str, str, str]]:
    """For an operator's property that says which list."""
    return [(each.name, each.name.replace("_", " ").title(), "") for each in RowList]


def cannot_change(context: bpy.types.Context) -> str | None:
    """Why nothing can be added to the lists, in a sentence; None where it can."""
    armature = chosen_armature(context)
    if armature is None or armature.type != "ARMATURE":
        return NO_ARMATURE
    return None if armature.is_editable else LINKED


class AddingOperator(OperatorMixin):
    """Mixin: an operator that may run wherever an armature is chosen that can be changed."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        why = cannot_change(context)
        if why is not None:
            cls.poll_message_set(why)
        return why is None


class RowOperator(OperatorMixin):
    """Mixin: an operator on the chosen row of `of`. own: whether rows of a library are refused."""

    of = RowList.CONSTRAINTS
    own = False

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        why = cannot_change(context)
        if why is None:
            armature = required_armature(context)
            index = cls.of.chosen(settings_of(armature))
            if index < 0:
                why = cls.of.nothing_chosen
            elif cls.own and index < cls.of.linked(armature):
                why = FROM_LIBRARY
        if why is not None:
            cls.poll_message_set(why)
        return why is None

    def row(self, context: bpy.types.Context) -> HangtimeConstraint:
        """The chosen row."""
        settings = settings_of(required_armature(context))
        row: HangtimeConstraint = self.of.rows(settings)[self.of.chosen(settings)]
        return row
