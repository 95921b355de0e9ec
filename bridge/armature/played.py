"""A recording that a strip of the artist's plays: it is read and copied as the scene shows it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from fractions import Fraction
from math import isclose

import bpy
import numpy as np

from ...solver.data.faults import (
    BlendedAction,
    Fault,
    NoAction,
    PosedByOthers,
    ScaledStrip,
    StripsOff,
    UnreadStrips,
    UnseenSupport,
)
from ..accessors import assigned_action, mapped_strip, mark_strips, pose_of, take_strips
from ..action_slots import all_curves, alone
from ..fake_users import free_copy
from ..played_strips import (
    ALL_MUTED,
    MUTED,
    STARRED,
    StripTime,
    played_strip,
    time_of,
    visible_strips,
    why_unread,
)
from ..unkeyed import PutBack
from . import fcurves
from .incremental import note_made_action

SAME_SCALE = 1e-3  # of a strip, to which it is none
LARGEST_DENOMINATOR, NEAR_RATIO = 8, 5e-3  # of a strip's scale that is meant to be a simple one
_TRIPLES = ("co", "handle_left", "handle_right")


def strip_time(owner: bpy.types.Object, action: bpy.types.Action) -> StripTime | None:
    """When a strip plays an action for an object; None where it is assigned, or every frame is
    shown at that frame."""
    strip = mapped_strip(owner, action)
    return time_of(strip) if strip is not None else None


def why_no_action(owner: bpy.types.Object) -> Fault:
    """Why nothing that animates an object can be read as a recording."""
    data, strips = owner.animation_data, visible_strips(owner)
    unseen = [strip for track in data.nla_tracks for strip in track.strips] if data else []
    if data is None or data.action is not None or not unseen:
        leaders = _leaders(owner)
        return PosedByOthers(owner.name, leaders) if leaders else NoAction(owner.name)
    if not data.use_nla:
        return StripsOff(owner.name, tuple(strip.name for strip in unseen))
    silent = MUTED if len(unseen) == 1 else ALL_MUTED
    why = why_unread(owner, strips) if strips else silent
    if why is None:
        return NoAction(owner.name)
    return UnreadStrips(owner.name, tuple(strip.name for strip in strips or unseen), why)


def _leaders(owner: bpy.types.Object) -> tuple[str, ...]:
    """Other armatures after which constraints pose an armature's bones, as in a retarget."""
    each = (c for bone in pose_of(owner).bones for c in bone.constraints if not c.mute)
    things = (thing for constraint in each for thing, _ in leaders_of(constraint))
    led = (t.name for t in things if t is not None and t != owner and t.type == "ARMATURE")
    return tuple(dict.fromkeys(led))


def leaders_of(constraint: bpy.types.Constraint) -> Iterator[tuple[bpy.types.Object | None, str]]:
    """Objects that a constraint follows, with the bone where it is one's."""
    if isinstance(constraint, bpy.types.ArmatureConstraint):
        yield from ((each.target, each.subtarget) for each in constraint.targets)
        return
    for thing, bone in (("target", "subtarget"), ("pole_target", "pole_subtarget")):
        yield getattr(constraint, thing, None), getattr(constraint, bone, "")


def wrong_speed(owner: bpy.types.Object, action: bpy.types.Action, told: UnseenSupport) -> Fault:
    """What makes a body fall at another frame rate than the scene's: the scale of the strip that
    plays the recording, where there is one, else the rate itself."""
    strip = mapped_strip(owner, action)
    scale = time_of(strip).scale if strip is not None else 1.0
    if strip is None or told.rate is None or abs(scale - 1.0) < SAME_SCALE:
        return told
    fitting = _simple(scale * told.scene_rate / told.rate)
    return ScaledStrip(
        told.first, told.last, told.rate, told.scene_rate, strip.name, scale, fitting
    )


def _simple(ratio: float) -> float:
    """A simple ratio where it is as near as falls can tell, else the ratio itself."""
    simple = float(Fraction(ratio).limit_denominator(LARGEST_DENOMINATOR))
    return simple if isclose(simple, ratio, rel_tol=NEAR_RATIO) else ratio


def require_unstarred(owner: bpy.types.Object) -> None:
    """Raises UnreadStrips where a starred track hides the action that is assigned, and would hide
    every result."""
    data = owner.animation_data
    if data is None or data.action is None or not data.use_nla:
        return
    starred = [track for track in data.nla_tracks if track.is_solo]
    if starred:
        names = tuple(strip.name for track in starred for strip in track.strips)
        raise UnreadStrips(owner.name, names, STARRED)


def require_unblended(owner: bpy.types.Object) -> None:
    """Raises BlendedAction where the action that is assigned is blended with strips below it: its
    keys, and those of any result, are not what is shown."""
    data = owner.animation_data
    if data is None or data.action is None:
        return
    alone = data.action_blend_type == "REPLACE" and data.action_influence == 1.0
    below = () if alone else tuple(strip.name for strip in visible_strips(owner))
    if below:
        raise BlendedAction(data.action.name, below)


def adopt_strip(owner: bpy.types.Object, action: bpy.types.Action) -> None:
    """Let a strip of the artist's that alone plays a take count as the take's strip: results are
    shown above it, and it may be hidden."""
    strip = played_strip(owner)
    if strip is not None and strip.action == action:
        mark_strips(owner, strip)


@contextmanager
def playing_strip(
    owner: bpy.types.Object, strip: bpy.types.NlaStrip, put_back: PutBack | None = None
) -> Iterator[None]:
    """Context in which of the assigned action, the takes' strips and what lies above only this one
    is seen. put_back: as of `fcurves.assign`."""
    data = owner.animation_data
    assert data is not None
    assigned, slot = assigned_action(owner), fcurves.slot_identifier(owner)
    every = list(data.nla_tracks)
    own = next(track for track in every if strip in list(track.strips))
    above, takes = every[every.index(own) + 1 :], [track for track, _ in take_strips(owner)]
    muting: list[bpy.types.NlaTrack | bpy.types.NlaStrip] = [own, strip]
    muting += [track for track in every if track != own and (track in above or track in takes)]
    muted = [(each, each.mute) for each in muting]
    fcurves.assign(owner, None, put_back=put_back)
    try:
        for each, _ in muted:
            each.mute = each not in (own, strip)
        yield
    finally:
        for each, mute in muted:
            each.mute = mute
        fcurves.assign(owner, assigned, slot, put_back)


def scene_copy(owner: bpy.types.Object, action: bpy.types.Action, name: str) -> bpy.types.Action:
    """A copy of a recording with its keys where the scene shows them: elsewhere only where a strip
    plays it sooner or later, slower or faster, or in part."""
    copy = alone(action)
    note_made_action(copy)
    copy.name = name
    free_copy(copy)
    time = strip_time(owner, action)
    if time is None:
        return copy
    for curve in all_curves(copy):
        _move(curve, time)
    for marker in copy.pose_markers:
        marker.frame = round(float(time.to_scene(np.array([float(marker.frame)]))[0]))
    if copy.use_frame_range:
        copy.frame_start, copy.frame_end = time.clipped(copy.frame_start, copy.frame_end)
    return copy


def _move(curve: bpy.types.FCurve, time: StripTime) -> None:
    """Put a curve's keys where the scene shows them. Modifiers count the action's frames: a curve
    with such gets keys of what it does."""
    if len(curve.modifiers):
        frames = np.arange(np.ceil(time.start), np.floor(time.end) + 1.0)
        values = np.array([curve.evaluate(frame) for frame in time.to_action(frames)])
        for modifier in list(curve.modifiers):
            curve.modifiers.remove(modifier)
        fcurves.put(curve, fcurves.linear_keys(fcurves.table(curve), frames, values))
        return
    fcurves.crop(curve, *time.to_action(np.array([time.start, time.end])).tolist())
    keys = fcurves.table(curve)
    for each in _TRIPLES:
        keys[each][:, 0] = time.to_scene(keys[each][:, 0].astype(float))
    fcurves.put(curve, keys)


@contextmanager
def in_scene_time(owner: bpy.types.Object, action: bpy.types.Action) -> Iterator[bpy.types.Action]:
    """A recording's action as the scene shows it: itself, or a copy that is gone afterwards."""
    if strip_time(owner, action) is None:
        yield action
        return
    copy = scene_copy(owner, action, action.name)
    try:
        yield copy
    finally:
        bpy.data.actions.remove(copy)
