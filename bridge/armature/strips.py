"""Takes as strips of the nonlinear animation: the untouched one below, results on top of it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy
import numpy as np

from ..accessors import IN_STRIP, take_strips

Strips = list[tuple[bpy.types.NlaTrack, bpy.types.NlaStrip]]


def strips_of(owner: bpy.types.Object, action: bpy.types.Action) -> Strips:
    """The strips of an action that Hangtime made for `owner`, with their tracks."""
    return [(track, strip) for track, strip in take_strips(owner) if strip.action == action]


def lay_strips(
    owner: bpy.types.Object, take: bpy.types.Action, result: bpy.types.Action, slot: str | None
) -> None:
    """Put a result into a strip that replaces the take's, which is laid below where it is not yet.

    No action is assigned any more; the result is what is shown. slot: identifier of the slot that
    both have for `owner`.
    """
    data = owner.animation_data_create()
    blend = data.action_blend_type, data.action_extrapolation, data.action_influence
    data.action = None
    if not strips_of(owner, take):
        strip = _lay(data, take, slot)
        strip.blend_type, strip.extrapolation, strip.influence = blend
    _lay(data, result, slot)
    show_strip(owner, result)


def _lay(
    data: bpy.types.AnimData, action: bpy.types.Action, slot: str | None
) -> bpy.types.NlaStrip:
    """A new strip above all others, which shows each frame of an action at that frame."""
    action[IN_STRIP] = True
    first, last = action.frame_range.to_tuple()
    start, end = float(np.floor(first)), float(np.ceil(last))
    track = data.nla_tracks.new()
    track.name = action.name
    strip = track.strips.new(action.name, int(start), action)
    slots = {each.identifier: each for each in getattr(action, "slots", ())}
    if slot in slots:
        strip.action_slot = slots[slot]
    strip.action_frame_start, strip.action_frame_end = start, end
    strip.frame_start, strip.frame_end = start, max(end, start + 1.0)
    strip.blend_type, strip.extrapolation = "REPLACE", "HOLD"
    return strip


def show_strip(owner: bpy.types.Object, action: bpy.types.Action) -> None:
    """Let a strip's action be seen: of the strips that Hangtime made only the take's below stays,
    and the action's own."""
    strips = take_strips(owner)
    for index, (track, strip) in enumerate(strips):
        track.mute = index > 0 and strip.action != action


def remove_strips(owner: bpy.types.Object, action: bpy.types.Action) -> None:
    """Remove the tracks of an action's strips."""
    data = owner.animation_data
    if data is None:
        return
    for track, _ in strips_of(owner, action):
        data.nla_tracks.remove(track)


@contextmanager
def without_strips(owner: bpy.types.Object) -> Iterator[None]:
    """Context in which no strip that Hangtime made is seen."""
    tracks = [(track, track.mute) for track, _ in take_strips(owner)]
    for track, _ in tracks:
        track.mute = True
    try:
        yield
    finally:
        for track, mute in tracks:
            track.mute = mute
