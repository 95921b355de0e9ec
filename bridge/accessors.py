"""Typed access to Blender's data where its stubs are wider than what is there, or know nothing.

Settings as a whole: `settings_of` and its like in properties/settings.py.
"""

from __future__ import annotations

from math import ceil, floor
from typing import Any, TypeVar

import bpy

from .action_slots import result_in, span_of
from .played_strips import played_strip, time_of

SHOWS = "hangtime_shows"  # of the action that holds a result's difference: the result, and
BESIDE = "hangtime_beside"  # what it is the difference from
ATTRIBUTE = "hangtime"  # under which scenes, objects, actions and bones carry what is stored
HOLDS = "hangtime_holds"  # of actions that hold settings: Blender 5.0.1 clears pointers to what is
# deleted only in actions that have a custom property
IN_STRIP = "hangtime_in_strip"  # of actions that Hangtime laid into strips; needs no registration

T = TypeVar("T")


def present(value: T | None) -> T:
    """What the stubs say may be missing though it is there: `context.scene`, an active object."""
    assert value is not None
    return value


def attached(owner: bpy.types.bpy_struct | None) -> Any:
    """The property group that ui/registration.py attaches to data-blocks and bones."""
    return getattr(owner, ATTRIBUTE)


def snapshot(owner: bpy.types.ID) -> dict[str, Any]:
    """All that was set of what is attached to a data-block, down to the last row: equal while
    nothing of it changes, whoever changes it. Some 0.05 ms for 20 constraints."""
    # From Blender 5.0 on it lies apart from the artist's own properties.
    apart = getattr(owner, "bl_system_properties_get", None)
    stored = owner if apart is None else apart()
    group = stored.get(ATTRIBUTE) if stored is not None else None
    return group.to_dict() if group is not None else {}


def source_of(action: bpy.types.Action) -> bpy.types.Action | None:
    """The take that a result was made from; None of an action that is no result."""
    recording: bpy.types.Action | None = attached(action).recording
    return recording


def called(action: bpy.types.Action) -> str:
    """A take's name as its list has it: without the recording's, with which results' names begin,
    so that there is room for what tells them apart."""
    root = action
    while (source := source_of(root)) is not None:
        root = source
    return action.name.removeprefix(f"{root.name} ")


def armature_data(armature: bpy.types.Object) -> bpy.types.Armature:
    """The armature's bones at rest, and how they are shown."""
    assert isinstance(armature.data, bpy.types.Armature)
    return armature.data


def pose_of(armature: bpy.types.Object) -> bpy.types.Pose:
    """The armature's pose bones."""
    return present(armature.pose)


def current_action(armature: bpy.types.Object) -> bpy.types.Action | None:
    """The take that animates the armature now: assigned, in a strip that Hangtime made, or in the
    only one of the artist's."""
    assigned = assigned_action(armature)
    if assigned is not None or armature.animation_data is None:
        return assigned
    seen = [strip for track, strip in take_strips(armature) if not (track.mute or strip.mute)]
    if seen:
        return shown_by(seen[-1])
    strip = played_strip(armature)
    return strip.action if strip is not None else None


def assigned_action(owner: bpy.types.Object) -> bpy.types.Action | None:
    """The action that is assigned to an object, or the result that its slot is."""
    data = owner.animation_data
    if data is None or data.action is None:
        return None
    return result_in(data.action, getattr(data, "action_slot", None)) or data.action


def shown_range(armature: bpy.types.Object, action: bpy.types.Action) -> tuple[float, float]:
    """First and last scene frame on which an armature shows a take."""
    first, last = span_of(action)
    strip = mapped_strip(armature, action)
    return (first, last) if strip is None else time_of(strip).clipped(first, last)


def play_to_end(scene: bpy.types.Scene, before: float, last: float) -> None:
    """Where a scene plays a take to its end, frame `before`, it plays what the take became to its
    own, frame `last`."""
    if floor(before) <= scene.frame_end < last:
        scene.frame_end = ceil(last)


def mapped_strip(armature: bpy.types.Object, action: bpy.types.Action) -> bpy.types.NlaStrip | None:
    """The strip that plays an action for an armature elsewhere than each frame at that frame; None
    where it is assigned."""
    if assigned_action(armature) == action:
        return None
    strips = [strip for _, strip in take_strips(armature) if strip.action == action]
    alone = played_strip(armature)
    if alone is not None and alone.action == action:
        strips.append(alone)
    return next((strip for strip in strips if not time_of(strip).whole), None)


def shown_by(strip: bpy.types.NlaStrip) -> bpy.types.Action | None:
    """The take that a strip shows: its action, or the result whose difference this holds."""
    action = strip.action
    return action if action is None else action.get(SHOWS) or action


def take_strips(
    armature: bpy.types.Object,
) -> list[tuple[bpy.types.NlaTrack, bpy.types.NlaStrip]]:
    """The strips that Hangtime made for an armature, with their tracks. The take's comes first,
    which may be the artist's own (see `adopt_strip`)."""
    data = armature.animation_data
    if data is None:
        return []
    strips = ((track, strip) for track in data.nla_tracks for strip in track.strips)
    return [each for each in strips if each[1].action and each[1].action.get(IN_STRIP)]


def current_scene() -> bpy.types.Scene:
    """The scene of Blender's context."""
    return present(bpy.context.scene)
