"""A result as a new slot of the action that holds its take (Blender 4.5; slots themselves are 4.4)."""

from __future__ import annotations

import bpy

from ...solver.data.faults import NoNewSlot
from ..accessors import present
from ..action_slots import bag_of, home_of, settle
from ..armature import fcurves
from ..armature.actions import recorded_action, show

_NO_SLOTS = "Blender before 4.5 cannot copy one"
_LINKED = "the action is linked from another file"


def require_slot(armature: bpy.types.Object) -> None:
    """Raises NoNewSlot where what results are made from can have no more slots."""
    take = present(recorded_action(armature))
    home = home_of(take)
    action = take if home is None else home[0]
    if not hasattr(bpy.types, "ActionSlot") or not _can_duplicate():
        raise NoNewSlot(action.name, _NO_SLOTS)
    if not action.is_editable:
        raise NoNewSlot(action.name, _LINKED)


def _can_duplicate() -> bool:
    return "duplicate" in bpy.types.ActionSlot.bl_rna.functions


def lay_in_slot(
    armature: bpy.types.Object, take: bpy.types.Action, result: bpy.types.Action
) -> None:
    """Move the keys of a result that an armature shows into a new slot of the action that holds the
    take it was made from, whose own slots stay as they are. The armature shows this slot.

    The slot starts as a copy of the take's, with its groups and modifiers. Pose markers are the
    whole action's, so those of the result are left out.
    """
    name = fcurves.slot_identifier(armature)
    home = home_of(take)
    action, old = home or (take, next(s for s in take.slots if s.identifier == name))
    beside = next(s for s in action.slots if s.identifier == name)
    made, curves = old.duplicate(), present(fcurves.holder_in(result, name))
    made.name_display = result.name
    _become(present(bag_of(action, made)), curves)
    for slot in list(result.slots):
        result.slots.remove(slot)
    for marker in list(result.pose_markers):
        result.pose_markers.remove(marker)
    result.use_frame_range = False
    settle(result, (action, made), beside)
    result.use_fake_user = True  # it lasts as long as its slot
    fcurves.assign(armature, result)
    show(armature, result)


def _become(made: bpy.types.ActionChannelbag, curves: fcurves.CurveHolder) -> None:
    """Let the copy of a take's curves be a result's, which were one too."""
    for curve in list(made.fcurves):
        if curves.fcurves.find(curve.data_path, index=curve.array_index) is None:
            made.fcurves.remove(curve)
    for curve in curves.fcurves:
        group = curve.group.name if curve.group is not None else ""
        own = fcurves.ensured(made, curve.data_path, curve.array_index, group)
        if not len(curve.modifiers):
            for modifier in list(own.modifiers):
                own.modifiers.remove(modifier)
        own.extrapolation, own.mute = curve.extrapolation, curve.mute
        fcurves.put(own, fcurves.table(curve))


def remove_slot(result: bpy.types.Action) -> None:
    """Remove the slot that a result is, if it is one."""
    home = home_of(result)
    if home is not None:
        home[0].slots.remove(home[1])
