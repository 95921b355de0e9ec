"""Slots of actions (Blender 4.4): which curves stand in which, and results that are slots.

A result that is a slot of its take's action has an action of its own as well, for what is stored
with it. That has no keys: wherever it is asked for these, it is the slot's that count.
"""

from __future__ import annotations

import bpy

_HOME = "hangtime_slot_in"  # of a result that is a slot: the action with the slot,
_SLOT = "hangtime_slot"  # the slot's handle, which outlasts its name,
_BESIDE = "hangtime_slot_beside"  # and that of the slot that animates its armature in the recording

Home = tuple["bpy.types.Action", "bpy.types.ActionSlot"]


def settle(result: bpy.types.Action, home: Home, beside: bpy.types.ActionSlot) -> None:
    """Let a result be a slot of an action from now on. beside: the recording's slot."""
    result[_HOME], result[_SLOT], result[_BESIDE] = home[0], home[1].handle, beside.handle


def home_of(result: bpy.types.Action) -> Home | None:
    """The action and the slot that a result is; None of others, and where the slot was deleted."""
    action = result.get(_HOME)
    slot = _with_handle(action, result[_SLOT]) if action is not None else None
    return None if slot is None else (action, slot)


def lost_slot(result: bpy.types.Action) -> bool:
    """Whether a result was a slot that the artist deleted, alone or with the action that held it:
    it has no keys any more."""
    return result.get(_SLOT) is not None and home_of(result) is None


def without_slot(owner: bpy.types.Object) -> bool:
    """Whether an action is assigned to an object that uses no slot of it, so that nothing moves."""
    data = owner.animation_data
    if data is None or data.action is None or not hasattr(data, "action_slot"):
        return False
    return bool(len(data.action.slots)) and data.action_slot is None


def result_in(
    action: bpy.types.Action, slot: bpy.types.ActionSlot | None
) -> bpy.types.Action | None:
    """The result that a slot of an action is; None of others."""
    if slot is None:
        return None
    handle = slot.handle
    results = (o for o in bpy.data.actions if o.get(_HOME) == action and o[_SLOT] == handle)
    return next(results, None)


def copied_slots(action: bpy.types.Action) -> dict[bpy.types.Action, bpy.types.ActionSlot]:
    """Where an action is a copy of one with results: these, and their slots' copies, as far as
    these are nobody's results yet."""
    copies = {}
    for result in bpy.data.actions:
        home = home_of(result)
        slot = _with_handle(action, home[1].handle) if home is not None else None
        # Handles are counted in each action, so that they tell nothing by themselves.
        if home is None or slot is None or slot.identifier != home[1].identifier:
            continue
        if result_in(action, slot) is None:
            copies[result] = slot
    return copies


def settle_copy(copy: bpy.types.Action, home: Home) -> None:
    """Let the copy of a result that is a slot be the copy of that slot."""
    copy[_HOME], copy[_SLOT] = home[0], home[1].handle


def recorded_slot(
    action: bpy.types.Action, slot: bpy.types.ActionSlot
) -> bpy.types.ActionSlot | None:
    """The slot itself, or of a result's the recording's beside it; None where that was deleted."""
    result = result_in(action, slot)
    return slot if result is None else _with_handle(action, result[_BESIDE])


def all_curves(action: bpy.types.Action) -> list[bpy.types.FCurve]:
    """F-curves of an action, of all of its slots where it has slots, but for results."""
    return [curve for held in holders_of(action) for curve in held.fcurves]


def holders_of(action: bpy.types.Action) -> list[bpy.types.Action | bpy.types.ActionChannelbag]:
    """Containers of an action's F-curves, of all of its slots where it has slots, but for
    results."""
    if not hasattr(action, "slots"):
        return [action]
    home = home_of(action)
    own = [slot for slot in action.slots if result_in(action, slot) is None]
    bags = [bag_of(*home)] if home is not None else [bag_of(action, slot) for slot in own]
    return [bag for bag in bags if bag is not None]


def span_of(action: bpy.types.Action) -> tuple[float, float]:
    """First and last frame of a take, whatever else is in its action."""
    home = home_of(action)
    shares = any(result_in(action, slot) is not None for slot in getattr(action, "slots", ()))
    if action.use_frame_range or (home is None and not shares):
        first, last = action.frame_range.to_tuple()
        return first, last
    ranges = [curve.range().to_tuple() for curve in all_curves(action)]
    return min(each[0] for each in ranges), max(each[1] for each in ranges)


def alone(action: bpy.types.Action) -> bpy.types.Action:
    """A copy of a take's action without what else is in it: results, and of a result that is a slot
    what it is beside. Its slots are called as the recording's are."""
    home = home_of(action)
    copy = (action if home is None else home[0]).copy()
    for slot in list(getattr(copy, "slots", ())):
        of_result = result_in(action, slot) is not None  # a copy's slots have the same handles
        if of_result if home is None else slot.handle != home[1].handle:
            copy.slots.remove(slot)
    if home is not None:
        copy.use_frame_range = False
        beside = _with_handle(home[0], action[_BESIDE])
        if beside is not None:
            copy.slots[0].name_display = beside.name_display
    return copy


def bag_of(
    action: bpy.types.Action, slot: bpy.types.ActionSlot | None
) -> bpy.types.ActionChannelbag | None:
    """Container of the curves of an action's slot."""
    if slot is None:
        return None
    strips = (strip for layer in action.layers for strip in layer.strips)
    bags = (keyframe_strip(strip).channelbag(slot) for strip in strips)
    return next((bag for bag in bags if bag is not None), None)


def keyframe_strip(strip: bpy.types.ActionStrip) -> bpy.types.ActionKeyframeStrip:
    """The only type of strip that there is."""
    assert isinstance(strip, bpy.types.ActionKeyframeStrip)
    return strip


def _with_handle(action: bpy.types.Action, handle: int) -> bpy.types.ActionSlot | None:
    return next((slot for slot in action.slots if slot.handle == handle), None)
