"""Types of operators: what their methods return, and what their mixins are."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import bpy

from .names import OperatorId

OperatorResult = set[Literal["RUNNING_MODAL", "CANCELLED", "FINISHED", "PASS_THROUGH", "INTERFACE"]]

NOT_OURS = "Hangtime has no operator “{}”"

if TYPE_CHECKING:
    OperatorMixin = bpy.types.Operator
else:  # Blender looks for properties in those bases only that are no types of its own
    OperatorMixin = object


class PolledOperator(OperatorMixin):
    """Mixin: an operator that is greyed out while there is an obstacle, which its tooltip tells."""

    @classmethod
    def obstacle(cls, context: bpy.types.Context) -> str | None:
        """A sentence why it cannot run now; None where it can."""
        raise NotImplementedError

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        why = cls.obstacle(context)
        if why is not None:
            cls.poll_message_set(why)
        return why is None

    def refuse(self, why: str, level: Literal["WARNING", "ERROR"] = "ERROR") -> OperatorResult:
        """Reports why nothing is done."""
        self.report({level}, why)
        return {"CANCELLED"}

    def go_on_with(self, name: str, **values: object) -> OperatorResult:
        """Invokes another of Hangtime's operators, by its bl_idname."""
        if name not in list(OperatorId):
            return self.refuse(NOT_OURS.format(name))
        category, _, own = name.partition(".")
        getattr(getattr(bpy.ops, category), own)("INVOKE_DEFAULT", **values)
        return {"FINISHED"}
