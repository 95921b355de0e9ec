"""The strip of the nonlinear animation that plays a recording: which it is, and when it plays what.

Blender shows frame `action_start + (frame - start) / scale` of a strip's action at a scene's frame
(anim_sys.cc, nlastrip_get_frame_actionclip), and holds both ends beyond the strip.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

from .action_slots import span_of

_SAME = 1e-4  # frames

SEVERAL = "are several, and what they make together has no keys of its own"
MUTED, ALL_MUTED = "is muted", "are all muted"
STARRED = "plays on a starred track, which would hide every result, so take the star off"


@dataclass(frozen=True)
class StripTime:
    """When a strip plays its action. start, end: scene frames; action_start: the action's at the
    first of these. scale: scene frames for each of the action's. whole: whether the strip plays all
    of its action, and every frame at that frame."""

    start: float
    end: float
    action_start: float
    scale: float
    whole: bool

    def to_scene(self, frames: NDArray[np.float64]) -> NDArray[np.float64]:
        """Scene frames (T,) at which the action's are shown."""
        return np.asarray(self.start + (frames - self.action_start) * self.scale)

    def to_action(self, frames: NDArray[np.float64]) -> NDArray[np.float64]:
        """Frames (T,) of the action that the scene's show."""
        return np.asarray(self.action_start + (frames - self.start) / self.scale)

    def clipped(self, first: float, last: float) -> tuple[float, float]:
        """Scene frames between which frames of the action are shown."""
        there = self.to_scene(np.array([first, last])).tolist()
        return max(there[0], self.start), min(there[1], self.end)


def time_of(strip: bpy.types.NlaStrip) -> StripTime:
    """When a strip plays its action, as long as it does so once, forwards and evenly."""
    assert strip.action is not None
    first, last = span_of(strip.action)
    scale = abs(strip.scale) or 1.0
    moved = abs(strip.frame_start - strip.action_frame_start) > _SAME or abs(scale - 1.0) > 1e-6
    cut = strip.action_frame_start > first + _SAME or strip.action_frame_end < last - _SAME
    return StripTime(
        strip.frame_start, strip.frame_end, strip.action_frame_start, scale, not (moved or cut)
    )


def visible_strips(owner: bpy.types.Object) -> list[bpy.types.NlaStrip]:
    """The strips that animate an object, of whichever kind; the topmost last."""
    data = owner.animation_data
    if data is None or not data.use_nla:
        return []
    tracks = [track for track in data.nla_tracks if not track.mute]
    solo = [track for track in tracks if track.is_solo]
    strips = [strip for track in solo or tracks for strip in track.strips]
    return [strip for strip in strips if not strip.mute]


def played_strip(owner: bpy.types.Object) -> bpy.types.NlaStrip | None:
    """The only strip that animates an object, where it alone does and can be read."""
    data = owner.animation_data
    if data is None or data.action is not None:
        return None
    strips = visible_strips(owner)
    return strips[0] if len(strips) == 1 and why_unread(owner, strips) is None else None


def why_unread(owner: bpy.types.Object, strips: list[bpy.types.NlaStrip]) -> str | None:
    """Why what an object's visible strips play cannot be read as one recording, to be said after
    their names; None where it can. At least one strip."""
    if len(strips) > 1:
        return SEVERAL
    (strip,) = strips
    data = owner.animation_data
    assert data is not None
    slots = list(getattr(strip.action, "slots", ()))
    reasons = {
        STARRED: any(track.is_solo for track in data.nla_tracks),
        "holds no action": strip.type != "CLIP" or strip.action is None,
        "plays no slot of its action": bool(slots) and strip.action_slot is None,
        "repeats its action": abs(strip.repeat - 1.0) > 1e-6,
        "plays backwards": strip.use_reverse,
        "has a keyed time": strip.use_animated_time,
        "has a keyed influence": strip.use_animated_influence,
        "fades in or out": max(strip.blend_in, strip.blend_out) > 0.0 or strip.use_auto_blend,
        "has modifiers": len(strip.modifiers) > 0,
        "adds to what is below": strip.blend_type not in {"REPLACE", "COMBINE"},
    }
    return next((reason for reason, holds in reasons.items() if holds), None)
