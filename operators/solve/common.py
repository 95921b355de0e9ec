"""What the operators share: the armature that they work on, and how they say what is wrong."""

from __future__ import annotations

import bpy

from ...bridge.accessors import current_action
from ...bridge.worker_client import shared
from ...solver.data.faults import Fault, NoAction, NoArmature
from .session import session

BUSY = "Hangtime is at work; wait for it, or press Esc in the viewport"
EDIT_MODE = "Leave edit mode first"


def chosen_armature(context: bpy.types.Context) -> bpy.types.Object | None:
    """The one chosen in the sidebar, else the active object if that is one."""
    chosen = context.scene.hangtime.armature
    if chosen is not None and chosen.name in context.scene.objects:
        return chosen
    active = context.view_layer.objects.active
    return active if active is not None and active.type == "ARMATURE" else None


def required_armature(context: bpy.types.Context) -> bpy.types.Object:
    """The same; raises NoArmature, for it may have been deleted since the button was pressed."""
    armature = chosen_armature(context)
    if armature is None:
        raise NoArmature(None)
    return armature


def hindrance(context: bpy.types.Context) -> str | None:
    """Why the armature cannot be read now, in a sentence; None where it can."""
    armature = chosen_armature(context)
    if shared().busy or session().solving is not None:
        return BUSY
    if armature is None or armature.type != "ARMATURE":
        active = context.view_layer.objects.active
        return said(NoArmature(active.name if active is not None else None))
    if armature.mode == "EDIT":
        return EDIT_MODE
    if current_action(armature) is None:
        return said(NoAction(armature.name))
    return None


def said(fault: Fault) -> str:
    """The fault's sentence."""
    from ..words.wording import (
        sentence,
    )  # loads half of the solver, which a mere start-up does not need

    return sentence(fault)


class FaultyOperator:
    """Mixin: `run` may raise what an artist can mend; that is reported, and nothing finished."""

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            return self.run(context)
        except Fault as fault:
            self.report({"ERROR"}, said(fault))
            return {"CANCELLED"}

    def run(self, context: bpy.types.Context) -> set[str]:
        """Does the work. Raises any Fault, having changed nothing."""
        raise NotImplementedError
