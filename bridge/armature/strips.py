"""Takes as strips of the nonlinear animation: the untouched one below, results on top of it.

A result's strip replaces what is below, or holds only the difference and is combined with it.
"""

from __future__ import annotations

from collections.abc import Iterator, Set
from contextlib import contextmanager
from typing import Literal, TypeAlias

import bpy
import numpy as np

from ..accessors import (
    BESIDE,
    SHOWS,
    assigned_action,
    attached,
    current_action,
    mark_strips,
    present,
    root_of,
    shown_by,
    source_of,
    take_strips,
)
from ..action_slots import all_curves, home_of, span_of
from ..marked_strips import Strips, set_seen
from ..unkeyed import PutBack
from . import fcurves

_SAME = 1e-3  # frames

Extrapolation: TypeAlias = Literal["NOTHING", "HOLD", "HOLD_FORWARD"]


def strips_of(owner: bpy.types.Object, action: bpy.types.Action) -> Strips:
    """The strips of the takes of `owner` that show an action, with their tracks."""
    return [(track, strip) for track, strip in take_strips(owner) if shown_by(strip) == action]


def _relatives(owner: bpy.types.Object, action: bpy.types.Action) -> Strips:
    """The strips of the takes of `owner` that go back to the same recording as an action."""
    root, strips = root_of(action), take_strips(owner)
    return [each for each in strips if (take := shown_by(each[1])) and root_of(take) == root]


def lay_strips(
    owner: bpy.types.Object,
    take: bpy.types.Action,
    result: bpy.types.Action,
    slot: str | None,
    difference: bpy.types.Action | None = None,
    *,
    alone: bool = False,
) -> None:
    """Put a result into a strip above the take's, which is laid below where it is not yet; strips
    of the artist's above the take's stay above, and so act on the result.

    No action is assigned any more; the result is what is shown. slot: identifier of the slot that
    all have for `owner`. difference: what combined with the take is the result; without it the
    result's strip replaces the take's. alone: nothing of the difference is seen beside its frames.
    """
    extrapolation = owner.animation_data_create().action_extrapolation
    fcurves.assign(owner, None)
    if not strips_of(owner, take):
        _lay(owner, take, take, slot).extrapolation = extrapolation
    ((_, below), *_) = strips_of(owner, take)
    if difference is None:
        _reach(_lay(owner, take, result, slot), below)
    else:
        difference[SHOWS], difference[BESIDE] = result, take
        strip = _lay(owner, take, difference, slot)
        strip.blend_type = "COMBINE"
        if alone:
            strip.extrapolation = "NOTHING"
        else:
            _reach(strip, below)
    show_strip(owner, result)


def _reach(strip: bpy.types.NlaStrip, below: bpy.types.NlaStrip) -> None:
    """Let a result's strip show as far beyond its ends as the take's: where that ends, other strips
    of the shot are seen; and until there, nothing is but the result."""
    if below.extrapolation == "HOLD":
        return
    start, end = below.frame_start, below.frame_end
    if strip.blend_type == "REPLACE":
        start, end = min(start, strip.frame_start), max(end, strip.frame_end)
    _span(strip, start, end)
    strip.extrapolation = below.extrapolation


def reach_as_strip(owner: bpy.types.Object) -> None:
    """Let a result that is assigned show as far beyond its ends as the strip of its take, where it
    has one and can. Else assigned actions do that as the artist has set it, which is kept till
    then."""
    data, settings, result = owner.animation_data, attached(owner), assigned_action(owner)
    if data is None:
        return
    reach = _reach_of(owner, result) if result is not None else None
    if reach is not None:
        settings.own_extrapolation = settings.own_extrapolation or data.action_extrapolation
        data.action_extrapolation = reach
    elif settings.own_extrapolation:
        data.action_extrapolation = settings.own_extrapolation
        settings.own_extrapolation = ""


def hidden_beyond(
    owner: bpy.types.Object, result: bpy.types.Action, *, in_slot: bool
) -> str | None:
    """Name of the strip of a result's take where the result, assigned, cannot show as far beyond
    its ends, and hides others. in_slot: whether it will be a slot."""
    below = _strip_below(owner, result)
    if below is None or (not in_slot and _reach_of(owner, result) == below.extrapolation):
        return None
    return below.name if below.extrapolation != "HOLD" else None


def _reach_of(owner: bpy.types.Object, result: bpy.types.Action) -> Extrapolation | None:
    """The extrapolation of its take's strip for a result that is assigned; None without a strip.

    It is held where it ends before the strip, of which the rest would be seen, and where it is a
    slot, whose ends are its whole action's to Blender.
    """
    below = _strip_below(owner, result)
    if below is None:
        return None
    first, last = span_of(result)
    reaches = first < below.frame_start + _SAME and last > below.frame_end - _SAME
    return below.extrapolation if reaches and home_of(result) is None else "HOLD"


def _strip_below(owner: bpy.types.Object, result: bpy.types.Action) -> bpy.types.NlaStrip | None:
    """The strip of what a result was made from, or of the next take before that has one."""
    take = source_of(result)
    while take is not None:
        playing = strips_of(owner, take)
        if playing:
            return playing[0][1]
        take = source_of(take)
    return None


def _span(strip: bpy.types.NlaStrip, start: float, end: float) -> None:
    """Let a strip show each frame of its action at that frame, between these."""
    strip.action_frame_start, strip.action_frame_end = start, end
    strip.frame_start, strip.frame_end = start, max(end, start + 1.0)


def layers_above(owner: bpy.types.Object, take: bpy.types.Action) -> list[str]:
    """Names of the artist's strips above the one that plays a take that add to it when they are
    seen; none where no strip plays it."""
    takes, playing = [strip for _, strip in take_strips(owner)], strips_of(owner, take)
    if not playing:
        return []
    every = list(present(owner.animation_data).nla_tracks)
    above = every[every.index(playing[0][0]) + 1 :]
    strips = (strip for track in above for strip in track.strips if strip not in takes)
    return [strip.name for strip in strips if strip.blend_type != "REPLACE"]


def _lay(
    owner: bpy.types.Object, take: bpy.types.Action, action: bpy.types.Action, slot: str | None
) -> bpy.types.NlaStrip:
    """A new strip above those of a take's relatives, or above all where there are none, which shows
    each frame of an action at that frame."""
    tracks, below = owner.animation_data_create().nla_tracks, _relatives(owner, take)
    first, last = _shown_span(action)
    start, end = float(np.floor(first)), float(np.ceil(last))
    track = tracks.new(prev=below[-1][0] if below else None)
    track.name = action.name
    strip = track.strips.new(action.name, int(start), action)
    slots = list(getattr(action, "slots", ()))
    named = [each for each in slots if each.identifier == slot]
    if slots:
        strip.action_slot = (named or slots)[0]
    _span(strip, start, end)
    strip.blend_type, strip.extrapolation = "REPLACE", "HOLD"
    mark_strips(owner, strip)
    return strip


def _shown_span(action: bpy.types.Action) -> tuple[float, float]:
    """First and last frame at which an assigned action moves anything: a manual frame range holds
    back no keys beyond it, while a strip would."""
    first, last = span_of(action)
    ranges = [curve.range() for curve in all_curves(action)]
    return min([first, *(each[0] for each in ranges)]), max([last, *(each[1] for each in ranges)])


def show_strip(owner: bpy.types.Object, action: bpy.types.Action) -> None:
    """Let a strip's take be seen, with those that it is the difference from, and hide the other
    results of its recording; this stays below as it is."""
    strips, left = _relatives(owner, action), current_action(owner)
    needed, seen = [action], set()
    while needed:
        showing = needed.pop()
        seen.add(showing)
        held = (strip.action for _, strip in strips if shown_by(strip) == showing)
        beside = (each.get(BESIDE) for each in held if each is not None)
        needed += [each for each in beside if each is not None and each not in seen]
    recording = root_of(action)
    for track, strip in strips:
        take = shown_by(strip)
        if take in seen or take != recording:
            set_seen(track, strip, take in seen)
    mark_strips(owner)
    if left is not None and left != action:
        PutBack()(owner, left)


def remove_strips(owner: bpy.types.Object, action: bpy.types.Action) -> None:
    """Remove an action's strips, the tracks that are empty then, and the difference that they
    hold."""
    data = owner.animation_data
    if data is None:
        return
    for track, strip in strips_of(owner, action):
        held = strip.action
        track.strips.remove(strip)
        if not len(track.strips):
            data.nla_tracks.remove(track)
        if held is not None and held != action:
            bpy.data.actions.remove(held)


def remove_strips_but(owner: bpy.types.Object, kept: Set[int]) -> None:
    """Remove the strips of the takes of `owner` that are not among those of these addresses, and
    the tracks that are empty then; their actions stay."""
    for track, strip in take_strips(owner):
        if strip.as_pointer() not in kept:
            track.strips.remove(strip)
            if not len(track.strips):
                present(owner.animation_data).nla_tracks.remove(track)


@contextmanager
def without_strips(owner: bpy.types.Object, put_back: PutBack) -> Iterator[None]:
    """Context in which no strip of the takes of `owner` is seen. put_back: has what only the result
    that is left has keys for as before it."""
    tracks = [(track, track.mute) for track, _ in take_strips(owner)]
    left = current_action(owner)
    for track, _ in tracks:
        track.mute = True
    if left is not None:
        put_back(owner, left)
    try:
        yield
    finally:
        for track, mute in tracks:
            track.mute = mute
