"""Frames that a recording lacks, put into a copy of its action, and those that are too many, taken
out of it; the recording stays."""

from __future__ import annotations

import json

import bpy
import numpy as np

from ...solver.data.faults import NotBetweenFrames, NotPutIn
from ...solver.doctor.local_poses import lagrange
from ...solver.doctor.repairs import MissingFrames
from ..accessors import assigned_action, current_scene, play_to_end, source_of
from ..action_slots import alone, span_of
from ..armature import fcurves
from ..armature.actions import recorded_action, show
from ..fake_users import free_copy, guard, unguard
from ..played_strips import played_strip
from ..properties.settings import action_settings, settings_of
from ..takes.takes import results_from
from .stored import FRAMES, findings

NAME = "{} filled"
_SUPPORT = np.array([-1, 0, 1, 2])  # keys about a gap, from the one before it on


def put_in(
    armature: bpy.types.Object,
    missing: tuple[MissingFrames, ...],
    before: tuple[MissingFrames, ...],
) -> None:
    """Has the armature perform its recording with these frames put in instead of those before;
    with none, as it was recorded. The range that is chosen, and findings, keep to their poses.
    Raises NotPutIn and NotBetweenFrames, having changed nothing."""
    shown = recorded_action(armature)
    if shown is None:
        return
    if source_of(shown) is not None:
        raise NotPutIn(shown.name, "it is a result and no recording")
    if played_strip(armature) is not None or assigned_action(armature) is None:
        raise NotPutIn(shown.name, "a strip plays it; assign it as the armature's action first")
    recorded: bpy.types.Action | None = action_settings(shown).unfilled
    if recorded is None:
        recorded, before = shown, ()
    first, last = span_of(recorded)
    for gap in missing:
        if not first <= gap.after < last:
            raise NotBetweenFrames(gap.after, first, last)
    made = _copied(armature, recorded, missing) if missing else recorded
    end = span_of(shown)[1]
    show(armature, made)
    play_to_end(current_scene(), end, span_of(made)[1])
    if shown != recorded and not shown.users:  # nothing was made of what was filled before
        bpy.data.actions.remove(shown)
        if made == recorded and not results_from(recorded):
            unguard(recorded)

    def now(frame: float) -> int:
        return round(_filled(_recorded(frame, before), missing))

    settings = settings_of(armature)
    settings.first_frame = now(settings.first_frame)
    settings.last_frame = now(settings.last_frame)
    for row in findings(settings):
        row.frames = json.dumps([tuple(map(now, span)) for span in FRAMES.of(row.frames)])


def _copied(
    armature: bpy.types.Object, recorded: bpy.types.Action, missing: tuple[MissingFrames, ...]
) -> bpy.types.Action:
    made = alone(recorded)
    made.name = NAME.format(recorded.name)
    free_copy(made)
    guard(recorded)
    action_settings(made).unfilled = recorded
    if made.use_frame_range:
        made.frame_start = _filled(made.frame_start, missing)
        made.frame_end = _filled(made.frame_end, missing)
    for marker in made.pose_markers:
        marker.frame = round(_filled(marker.frame, missing))
    curves = fcurves.holder_in(made, fcurves.slot_identifier(armature))
    if curves is not None:
        fcurves.align_quaternions(curves.fcurves)
        for curve in curves.fcurves:
            _put_into(curve, missing)
    return made


def _put_into(curve: bpy.types.FCurve, missing: tuple[MissingFrames, ...]) -> None:
    """Moves keys that come later, and of those that then are on one frame leaves the first, whose
    pose they hold. Where frames on both sides of a gap have keys, gives those in it keys on the
    curve through them."""
    keys = fcurves.table(curve)
    at, values = keys["co"].T.astype(float)
    frames, added = list[float](), list[float]()
    for gap in (gap for gap in missing if gap.count > 0):
        near = [int(k) for k in np.searchsorted(at, gap.after + _SUPPORT) if k < len(at)]
        near = [k for k, frame in zip(near, gap.after + _SUPPORT, strict=False) if at[k] == frame]
        if not {gap.after, gap.after + 1} <= set(at[near]):
            continue
        around = values[near]
        if "rotation_euler" in curve.data_path:
            around = np.unwrap(around)
        sound = np.array([_filled(at[k], missing) for k in near], int)
        first = int(_filled(gap.after, missing)) + 1
        for frame in range(first, first + gap.count):
            used, weights = lagrange(sound, frame)
            added.append(float(weights @ around[np.searchsorted(sound, used)]))
            frames.append(frame)
    moved = np.array([_filled(frame, missing) for frame in at])
    for name in ("co", "handle_left", "handle_right"):
        keys[name][:, 0] += moved - at
    stay = np.diff(moved, prepend=-np.inf) > 0.0
    keys = {name: column[stay] for name, column in keys.items()}
    more = fcurves.linear_keys(keys, np.array(frames), np.array(added))
    fcurves.put(curve, fcurves.joined(keys, more))
    curve.update()


def _filled(frame: float, missing: tuple[MissingFrames, ...]) -> float:
    """Where a recorded frame goes; one that is taken out to the pose that it repeats."""
    return frame + sum(max(gap.count, gap.after - frame) for gap in missing if frame > gap.after)


def _recorded(frame: float, missing: tuple[MissingFrames, ...]) -> float:
    """The recorded frame of one of the filled take; of those put in the next."""
    for gap in missing:
        if frame > gap.after:
            frame = max(gap.after + 1, frame - gap.count)
    return frame
