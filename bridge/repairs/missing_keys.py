"""Frames that a recording lacks, put into a copy of its action, and those that are too many, taken
out of it; the recording stays."""

from __future__ import annotations

import json
from collections.abc import Sequence

import bpy
import numpy as np

from ...solver.data.faults import NotPutIn
from ...solver.doctor.local_poses import lagrange
from ...solver.doctor.repairs import MissingFrames, check_missing, filled_frame, recorded_frame
from ..accessors import assigned_action, current_scene, play_to_end, source_of
from ..action_slots import alone, span_of
from ..armature import fcurves
from ..armature.actions import recorded_action, show
from ..fake_users import free_copy, guard, unguard
from ..played_strips import played_strip
from ..properties.action import action_settings
from ..properties.settings import settings_of
from ..takes.takes import results_from
from .stored import FRAMES, findings, repairs_in

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
    check_missing(missing, first, last)
    made = _copied(armature, recorded, missing) if missing else recorded
    end = span_of(shown)[1]
    show(armature, made)
    play_to_end(current_scene(), end, span_of(made)[1])
    if shown != recorded and not shown.users:  # nothing was made of what was filled before
        bpy.data.actions.remove(shown)
        if made == recorded and not results_from(recorded):
            unguard(recorded)

    settings = settings_of(armature)
    settings.first_frame = _now(settings.first_frame, before, missing)
    settings.last_frame = _now(settings.last_frame, before, missing)
    for row in findings(settings):
        # What a row's own remedy takes out it tells as it was, to be shown once more.
        own = [gap for gap in repairs_in(row.remedy).missing if gap.count < 0]
        was, will = ([gap for gap in each if gap not in own] for each in (before, missing))
        spans = [[_now(frame, was, will) for frame in span] for span in FRAMES.of(row.frames)]
        row.frames = json.dumps(spans)


def _now(frame: float, before: Sequence[MissingFrames], missing: Sequence[MissingFrames]) -> int:
    """Where a frame of the take that was filled before is in the one that is filled now."""
    return round(filled_frame(recorded_frame(frame, before), missing))


def _copied(
    armature: bpy.types.Object, recorded: bpy.types.Action, missing: tuple[MissingFrames, ...]
) -> bpy.types.Action:
    made = alone(recorded)
    made.name = NAME.format(recorded.name)
    free_copy(made)
    guard(recorded)
    action_settings(made).unfilled = recorded
    if made.use_frame_range:
        made.frame_start = filled_frame(made.frame_start, missing)
        made.frame_end = filled_frame(made.frame_end, missing)
    for marker in made.pose_markers:
        marker.frame = round(filled_frame(marker.frame, missing))
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
        sound = np.array([filled_frame(at[k], missing) for k in near], int)
        first = int(filled_frame(gap.after, missing)) + 1
        for frame in range(first, first + gap.count):
            used, weights = lagrange(sound, frame)
            added.append(float(weights @ around[np.searchsorted(sound, used)]))
            frames.append(frame)
    moved = np.array([filled_frame(frame, missing) for frame in at])
    for name in ("co", "handle_left", "handle_right"):
        keys[name][:, 0] += moved - at
    stay = np.diff(moved, prepend=-np.inf) > 0.0
    keys = {name: column[stay] for name, column in keys.items()}
    more = fcurves.linear_keys(keys, np.array(frames), np.array(added))
    fcurves.put(curve, fcurves.joined(keys, more))
    curve.update()
