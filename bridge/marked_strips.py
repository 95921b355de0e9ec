"""Which strips of the nonlinear animation Hangtime shows and hides for an armature: those that it
laid, and the artist's own that play its takes. The armature keeps their names.

Actions could not tell: others may play them, and one that is linked keeps no mark.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any

import bpy

from .hidden_texts import HiddenText, listed, word

Strips = list[tuple[bpy.types.NlaTrack, bpy.types.NlaStrip]]

_OF_ACTION = "hangtime_in_strip"  # by which earlier versions marked the actions of such strips


def marked_strips(data: bpy.types.AnimData, marks: str) -> Strips:
    """The strips that are marked, from the lowest on; without any those of earlier versions.

    Blender lets no two strips of an armature have the same name. One that was renamed is the only
    one that plays its action.
    """
    every = [(track, strip) for track in data.nla_tracks for strip in track.strips]
    kept = MARKS.of(marks)
    if not kept:
        flagged = [e for e in every if e[1].action is not None and e[1].action.get(_OF_ACTION)]
        played = [strip.action for _, strip in every]
        return [each for each in flagged if played.count(each[1].action) == 1]
    names = {strip.name for _, strip in every}
    ours = {name for name, _ in kept if name in names}
    for action in (action for name, action in kept if name not in names):
        playing = [s.name for _, s in every if s.action and s.action.name_full == action]
        if len(playing) == 1:
            ours.update(playing)
    return [each for each in every if each[1].name in ours]


def marks_of(strips: Iterable[bpy.types.NlaStrip]) -> str:
    """By which these strips are found again."""
    kept = [(strip.name, strip.action.name_full) for strip in strips if strip.action is not None]
    return json.dumps(kept)


def is_seen(track: bpy.types.NlaTrack, strip: bpy.types.NlaStrip) -> bool:
    """Whether neither a strip nor its track is muted."""
    return not (track.mute or strip.mute)


def set_seen(track: bpy.types.NlaTrack, strip: bpy.types.NlaStrip, seen: bool) -> None:
    """Show or hide a strip. The others of its track go on as they are, but where that is muted,
    which would hide the strip."""
    if seen:
        track.mute = strip.mute = False
    elif is_seen(track, strip):
        (track if len(track.strips) == 1 else strip).mute = True


def _read(content: Any) -> tuple[tuple[str, str], ...]:
    return tuple((word(name), word(action)) for name, action in map(listed, listed(content)))


MARKS: HiddenText[tuple[tuple[str, str], ...]] = HiddenText("take_strips", _read, ())
