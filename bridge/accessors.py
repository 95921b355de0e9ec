"""Typed access to Blender's data where its stubs are wider than what is there, or know nothing.

Settings as a whole: `settings_of` and its like in properties/settings.py.
"""

from __future__ import annotations

from math import ceil, floor
from typing import Any, TypeVar

import bpy

from .action_slots import result_in, span_of
from .marked_strips import Strips, is_seen, marked_strips, marks_of
from .played_strips import played_strip, time_of

SHOWS = "hangtime_shows"  # of the action that holds a result's difference: the result, and
BESIDE = "hangtime_beside"  # what it is the difference from
ATTRIBUTE = "hangtime"  # under which scenes, objects, actions and bones carry what is stored
HOLDS = "hangtime_holds"  # of actions that hold settings: Blender 5.0.1 clears pointers to what is
# deleted only in actions that have a custom property

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


def root_of(action: bpy.types.Action) -> bpy.types.Action:
    """The recording that a take goes back to."""
    while (source := source_of(action)) is not None:
        action = source
    return action


def called(action: bpy.types.Action) -> str:
    """A take's name as its list has it: without the recording's, with which results' names begin,
    so that there is room for what tells them apart."""
    return action.name.removeprefix(f"{root_of(action).name} ")


def armature_data(armature: bpy.types.Object) -> bpy.types.Armature:
    """The armature's bones at rest, and how they are shown."""
    assert isinstance(armature.data, bpy.types.Armature)
    return armature.data


def pose_of(armature: bpy.types.Object) -> bpy.types.Pose:
    """The armature's pose bones."""
    return present(armature.pose)


def current_action(armature: bpy.types.Object) -> bpy.types.Action | None:
    """The take that animates the armature now: assigned, in a strip of its takes, or in the only
    one that there is."""
    assigned, data = assigned_action(armature), armature.animation_data
    if assigned is not None or data is None or not data.use_nla:
        return assigned
    ours = take_strips(armature)
    seen = [each for each in ours if is_seen(*each)]
    if seen:
        return None if _is_covered(data, seen[-1], ours) else shown_by(seen[-1][1])
    strip = played_strip(armature)
    return strip.action if strip is not None else None


def _is_covered(
    data: bpy.types.AnimData, seen: tuple[bpy.types.NlaTrack, bpy.types.NlaStrip], ours: Strips
) -> bool:
    """Whether a strip of the artist's plays the same take, or another result of its recording,
    above a strip that is seen and in its place. ours: the strips of takes."""
    track, strip = seen
    take, names = shown_by(strip), {each.name for _, each in ours}
    every = list(data.nla_tracks)
    above = (
        (t, s) for t in every[every.index(track) + 1 :] for s in t.strips if s.name not in names
    )
    return take is not None and any(
        is_seen(*each)
        and each[1].blend_type == "REPLACE"
        and each[1].action is not None
        and root_of(each[1].action) == root_of(take)
        and each[1].frame_start < strip.frame_end
        and strip.frame_start < each[1].frame_end
        for each in above
    )


def assigned_action(owner: bpy.types.Object) -> bpy.types.Action | None:
    """The action that is assigned to an object, or the result that its slot is."""
    data = owner.animation_data
    if data is None or data.action is None:
        return None
    return result_in(data.action, getattr(data, "action_slot", None)) or data.action


def played_source(armature: bpy.types.Object, action: bpy.types.Action) -> bpy.types.Action:
    """What a take that an armature shows was made from; the take itself of a recording, and of a
    result that came into another shot, in a strip there: nothing of its sources is played."""
    source = source_of(action)
    return action if source is None or _came_alone(armature, action) else source


def _came_alone(armature: bpy.types.Object, action: bpy.types.Action) -> bool:
    """Whether a strip plays a result that was made for another armature, or of other frames, and no
    strip what it goes back to."""
    if assigned_action(armature) is not None:
        return False
    played = {shown_by(strip) for _, strip in take_strips(armature)}
    source = source_of(action)
    while source is not None:
        if source in played:
            return False
        source = source_of(source)
    return not made_for(armature, action) or mapped_strip(armature, action) is not None


def made_for(armature: bpy.types.Object, result: bpy.types.Action) -> bool:
    """Whether a result is an armature's own. Those of earlier versions do not tell, and are of any;
    those of a deleted one are of none."""
    made = attached(result)
    return bool(made.maker == armature or (made.maker is None and not made.owned))


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


def take_strips(armature: bpy.types.Object) -> Strips:
    """The strips of an armature's takes, with their tracks, from the lowest on: those that Hangtime
    made, and those of the artist's that it may hide (see `adopt_strip`)."""
    data, settings = armature.animation_data, getattr(armature, ATTRIBUTE, None)
    if data is None:
        return []
    return marked_strips(data, settings.take_strips if settings is not None else "")


def mark_strips(armature: bpy.types.Object, *more: bpy.types.NlaStrip) -> None:
    """Note the strips of an armature's takes by what they are called now. more: those that count
    among them from now on."""
    known = [strip for _, strip in take_strips(armature) if strip not in more]
    attached(armature).take_strips = marks_of([*known, *more])


def current_scene() -> bpy.types.Scene:
    """The scene of Blender's context."""
    return present(bpy.context.scene)
