"""Where the objects that points shall follow are over the result's frames: they keep the scene's
time, however the result's phases are retimed."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import bpy
import numpy as np

from ...solver.analysis.timeline import MOST_ADDED
from ...solver.arrays import FloatArray
from ...solver.data.requests import Path
from ..accessors import current_scene
from ..armature import fcurves
from ..armature.incremental import complete
from ..armature.poses import frames_per_second
from ..constraint_kinds import hold, point, timing
from ..movable import may_move
from ..properties.constraint import HangtimeConstraint
from ..rows.times import Clip, Frames
from ..scene.seen import seen_at, simulate

LONGER = 1.0  # of the clip's duration, as a result may get without a row that asks for it


def paths_of(rows: Iterable[HangtimeConstraint], clip: Clip, metres: float) -> dict[str, Path]:
    """The paths of those points that follow a target, by the row's name.

    rows: all that are used. metres: per Blender unit. The scene's frame, and what is seen, are
    afterwards what they were.
    """
    every = list(rows)
    following = [r for r in every if r.kind == point.KIND.name and r.target is not None]
    frames = _whole_frames(*_possible_frames(every, clip))
    targets = {row.target for row in following}
    moving = [target for target in targets if not _moves_by_keys_alone(target)]
    seen = _sampled([t for t in moving if may_move(t)], frames)
    seen |= _sampled([t for t in moving if not may_move(t)], frames[:1])
    paths = {}
    for row in following:
        places = seen[row.target] if row.target in moving else _keyed(row.target, frames)
        paths[row.name] = _path(frames[: len(places)], metres * places)
    return paths


def _possible_frames(rows: Iterable[HangtimeConstraint], clip: Clip) -> Frames:
    """First frame of a result, and the last that it could have: the solver alone knows durations.

    rows: all that are asked for.
    """
    first, last = clip.ends
    rate = frames_per_second(current_scene())
    asked = 0.0  # s, by rows
    for row in rows:
        if row.kind == timing.KIND.name and timing.by_factor(row):
            asked += row.factor * (last - first) / rate
        elif row.kind in (hold.KIND.name, timing.KIND.name):
            asked += row.seconds
    return first, last + LONGER * (last - first) + rate * min(asked, MOST_ADDED)


def _whole_frames(first: float, last: float) -> FloatArray:
    """The whole frames within, and both ends."""
    inside = np.arange(np.ceil(first), np.floor(last) + 1.0)
    return np.asarray(np.unique([first, *inside, max(first, last)]))


def _path(frames: FloatArray, places: FloatArray) -> Path:
    """A path without its ends at rest, where it would say the same again."""
    moves = np.flatnonzero((np.diff(places, axis=0) != 0.0).any(axis=1))
    kept = slice(moves[0], moves[-1] + 2) if len(moves) else slice(1)
    return Path(tuple(frames[kept].tolist()), tuple(map(tuple, places[kept].tolist())))


def _moves_by_keys_alone(target: bpy.types.Object) -> bool:
    """Whether an object is where its own keys put it, so that nothing else need be evaluated."""
    data = target.animation_data
    driven = data is not None and (len(data.drivers) > 0 or (data.use_nla and len(data.nla_tracks)))
    physical = target.rigid_body is not None or len(target.constraints) > 0
    return target.parent is None and not driven and not physical


def _keyed(target: bpy.types.Object, frames: FloatArray) -> FloatArray:
    """(T, 3) places of an object that is moved by keys alone, Blender units."""
    places = np.tile(np.array(target.location, float), (len(frames), 1))
    for curve in fcurves.curves_of(target):
        if curve.data_path == "location" and not curve.mute:
            places[:, curve.array_index] = [curve.evaluate(frame) for frame in frames]
    return np.asarray(places + np.array(target.delta_location, float))


def _sampled(
    targets: Sequence[bpy.types.Object], frames: FloatArray
) -> dict[bpy.types.Object, FloatArray]:
    """(T, 3) places of each object in Blender's evaluated scene, Blender units."""
    if not targets:
        return {}
    complete(simulate(targets, frames[-1]))
    seen = seen_at(targets, frames, lambda each: np.array(each.matrix_world.translation))
    return dict(zip(targets, np.array(seen, float).transpose(1, 0, 2), strict=True))
