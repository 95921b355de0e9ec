"""Where the objects that points shall follow are over time."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ...solver.data.requests import Path
from ..armature import fcurves
from ..armature.incremental import complete
from ..constraint_kinds import point
from ..properties.constraint import HangtimeConstraint
from ..rows.times import Clip, followed_frames
from ..scene.seen import seen_at, simulate


def paths_of(rows: Iterable[HangtimeConstraint], clip: Clip, metres: float) -> dict[str, Path]:
    """The paths of those points that follow a target, by the row's name.

    metres: per Blender unit. The scene's frame, and what is seen, are afterwards what they were.
    Raises as `when_of`.
    """
    following = [r for r in rows if r.kind == point.KIND.name and r.target is not None]
    frames = {row.name: _whole_frames(*followed_frames(row, clip)) for row in following}
    targets = {row.target for row in following}
    moving = [target for target in targets if not _moves_by_keys_alone(target)]
    needed = sorted({f for r in following if r.target in moving for f in frames[r.name].tolist()})
    seen = _sampled(moving, needed)
    paths = {}
    for row in following:
        mine = frames[row.name]
        if row.target in moving:
            places = seen[row.target][np.searchsorted(needed, mine)]
        else:
            places = _keyed(row.target, mine)
        paths[row.name] = Path(tuple(mine.tolist()), tuple(map(tuple, (metres * places).tolist())))
    return paths


def _whole_frames(first: float, last: float) -> FloatArray:
    """The whole frames within, and both ends."""
    inside = np.arange(np.ceil(first), np.floor(last) + 1.0)
    return np.asarray(np.unique([first, *inside, max(first, last)]))


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
    targets: Sequence[bpy.types.Object], frames: Sequence[float]
) -> dict[bpy.types.Object, FloatArray]:
    """(T, 3) places of each object in Blender's evaluated scene, Blender units."""
    if not targets:
        return {}
    complete(simulate(targets, frames[-1]))
    seen = seen_at(targets, np.array(frames), lambda each: np.array(each.matrix_world.translation))
    return dict(zip(targets, np.array(seen, float).transpose(1, 0, 2), strict=True))
