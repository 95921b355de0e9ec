"""Types of operators: what their methods return, and what their mixins are."""

from typing import TYPE_CHECKING, Literal

import bpy

OperatorResult = set[Literal["RUNNING_MODAL", "CANCELLED", "FINISHED", "PASS_THROUGH", "INTERFACE"]]

if TYPE_CHECKING:
    OperatorMixin = bpy.types.Operator
else:  # Blender looks for properties in those bases only that are no types of its own
    OperatorMixin = object
