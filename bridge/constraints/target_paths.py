"""Where the objects that points shall follow are over the result's frames: they keep the scene's
time, however the result's phases are retimed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np

from ...solver.analysis.timeline import MOST_ADDED
from ...solver.arrays import FloatArray
from ...solver.data.contacts import PhaseKind
from ...solver.data.requests import Hold, Path, PhaseTiming
from ..armature import fcurves
from ..armature.incremental import complete
from ..constraint_kinds import point
from ..movable import may_move
from ..properties.constraint import HangtimeConstraint
from ..rows.times import Clip, Frames, throughout
from ..scene.seen import seen_at, simulate

# Beside what is asked for, jumps alone get other durations, which go with where they land.
LONGER = 2.0  # of a flight's duration, by which it may get longer: a jump nine times as high
LONGER_ANYWAY = 1.0  # s, where that is more: alone a jump of 1.2 m, higher than anybody's
PUSH = 0.3  # of the time before, as a push may get longer or shorter (SPEED_RATIO in the solver)
BESIDE = 2.0  # frames on both sides, between which places are interpolated


@dataclass(frozen=True)
class Durations:
    """What changes durations: held frames and timings that are asked for, and whether jumps get
    those that go with where they land. rate: frames a second."""

    rate: float
    holds: tuple[Hold, ...] = ()
    timings: tuple[PhaseTiming, ...] = ()
    free: bool = True

    def reached(self, row: Any, clip: Clip) -> Frames:
        """First and last frame of a result at which a row may hold, and some beside them."""
        held = {hold.name: (hold.frame, hold.frame) for hold in self.holds}
        first, last = throughout(row, {**held, **clip.phases})
        begins, ends = clip.ends
        first, last = min(max(first, begins), ends), max(min(last, ends), begins)
        changes = [*self._asked(last, clip.phases), *self._free(last, clip)]
        sooner, later = (sum(each) for each in zip((0.0, 0.0), *changes, strict=True))
        return max(first - sooner - BESIDE, begins), last + later + BESIDE

    def _asked(self, last: float, phases: Mapping[str, Frames]) -> Iterator[Frames]:
        """By how many frames what is asked for moves a frame, at most: sooner, and later."""
        most = MOST_ADDED * self.rate  # a solve refuses more
        for hold in self.holds:
            if hold.frame <= last + BESIDE:
                yield 0.0, min(hold.seconds * self.rate, most)
        for timing in self.timings:
            begins, ends = phases.get(timing.phase, (last, last))
            if begins < last:
                length = ends - begins
                wanted = length * (timing.factor or 1.0)
                if timing.seconds is not None:
                    wanted = timing.seconds * self.rate
                yield max(length - wanted, 0.0), min(max(wanted - length, 0.0), most)

    def _free(self, last: float, clip: Clip) -> Iterator[Frames]:
        """Likewise for the durations of jumps."""
        named = clip.phases.items()
        flights = [ends for name, ends in named if name.startswith(PhaseKind.FLIGHT.value)]
        if not self.free or not flights:
            return
        push = PUSH * (last - clip.ends[0])
        yield push, push
        for begins, ends in flights:
            passed = min(last, ends) - begins
            if passed > 0.0:
                yield passed, max(LONGER * passed, LONGER_ANYWAY * self.rate)


def paths_of(
    rows: Iterable[HangtimeConstraint],
    clip: Clip,
    metres: float,
    durations: Durations,
    known: Mapping[str, Path],
) -> dict[str, Path]:
    """The paths of those points that follow a target, by the row's name.

    metres: per Blender unit. known: paths that were taken before, for the whole scene is evaluated
    at each of a path's frames. The scene's frame, and what is seen, are afterwards what they were.
    """
    following = [r for r in rows if r.kind == point.KIND.name and r.target is not None]
    paths = {row.name: known[row.name] for row in following if row.name in known}
    new = [row for row in following if row.name not in paths]
    frames = {row.name: _whole_frames(*durations.reached(row, clip)) for row in new}
    moving = {row.target for row in new if not _moves_by_keys_alone(row.target)}
    every = np.unique([f for row in new if row.target in moving for f in frames[row.name]])
    seen = _sampled([target for target in moving if may_move(target)], every)
    still = _sampled([target for target in moving if not may_move(target)], every[:1])
    for row in new:
        target, at = row.target, frames[row.name]
        if target in seen:
            places = seen[target][np.isin(every, at)]
        else:
            places = still[target] if target in still else _keyed(target, at)
        paths[row.name] = _path(at[: len(places)], metres * places)
    return paths


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
