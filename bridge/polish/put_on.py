"""Hand polish put on a new result: as keys of its own, so that there is one action to edit."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import bpy
import numpy as np

from ...solver.arrays import BoolArray, FloatArray
from ..armature import fcurves
from ..takes.key_splice import FullTurns, anchor, key_span, splice
from ..takes.take_time import TakeTime, mapped
from .hand_offsets import HandOffset, Polish, acting, default_of
from .samples import CurveSamples, Written, edited_action, sampled

_NO_TURNS = FullTurns()


@dataclass(frozen=True)
class PlacedPolish:
    """Where a polish comes to lie in a new result. new: that one's curves, without it.

    time: where the take's frames are in the new one. at: (T,) frames of the polished result that
    the new one's show. lost: first and last frame of the polished one, of polish for which the new
    one has no frames; None where there is none.
    """

    polish: Polish
    new: CurveSamples
    time: TakeTime
    at: FloatArray
    lost: tuple[float, float] | None

    @property
    def frames(self) -> FloatArray:
        """Frames (T,) of the new result that are polished."""
        offsets = (each.at(self.polish.frames, self.at) for each in self.polish.offsets)
        where = [acting(each) for each in offsets]
        return self.new.frames[np.any(where, axis=0)] if where else np.empty(0)


def placed(
    action: bpy.types.Action, slot: str | None, polish: Polish, time: TakeTime
) -> PlacedPolish:
    """A polish in a new result's slot, by the take's frames. time: where these are in it."""
    new = sampled(action, slot)
    there = time.to_result(polish.time.to_recorded(polish.frames))
    within = (there > new.frames[0] - 1.0) & (there < new.frames[-1] + 1.0)
    acts = [acting(offset.values) for offset in polish.offsets]
    gone = polish.frames[np.any(acts, axis=0) & ~within] if acts else np.empty(0)
    lost = (float(gone[0]), float(gone[-1])) if len(gone) else None
    at = polish.time.to_result(time.to_recorded(new.frames))
    return PlacedPolish(polish, new, time, at, lost)


def put_on(
    action: bpy.types.Action,
    slot: str | None,
    place: PlacedPolish,
    before: Written,
    owned: Collection[str],
) -> None:
    """Put polish on a new result's slot; channels that physics does not own get the edited keys
    themselves. before: the polished result as it was made. owned: paths of those that it does."""
    polish, new = place.polish, place.new
    holder, edited = fcurves.holder_in(action, slot), edited_action(polish.result)
    source = fcurves.holder_in(edited, slot) if edited == polish.result else None
    assert holder is not None
    for offset in polish.offsets:
        alone = source is not None and offset.path not in owned
        if not (alone and _copied(holder, source, offset, place, before)):
            _bake(holder, offset, new, offset.at(polish.frames, place.at))
    action.update_tag()


def _bake(
    holder: fcurves.CurveHolder, offset: HandOffset, new: CurveSamples, offsets: FloatArray
) -> None:
    """Key a property on every whole frame on which it is polished. offsets: (T, n) there."""
    defaults = [default_of((offset.path, index)) for index in offset.indices]
    base = np.stack(
        [
            new.at((offset.path, index), new.frames, default)
            for index, default in zip(offset.indices, defaults, strict=True)
        ],
        axis=1,
    )
    group = fcurves.bone_of(offset.path) or ""
    for run in _runs(acting(offsets)):
        frames, values = new.frames[run], offset.put_on(base[run], offsets[run])
        between = float(frames[0]) - 1.0, float(frames[-1]) + 1.0
        beside = tuple(f if new.frames[0] <= f <= new.frames[-1] else None for f in between)
        for k, index in enumerate(offset.indices):
            curve = fcurves.ensured(holder, offset.path, index, group)
            anchor(curve, between, (beside[0], beside[1]), defaults[k])
            splice(curve, frames, values[:, k], between, _NO_TURNS)


def _runs(where: BoolArray) -> list[slice]:
    """Stretches of neighbours that are true."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], where, [False]]).astype(int)))
    return [slice(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def _moved_alone(
    offset: HandOffset, place: PlacedPolish, before: Written
) -> tuple[FloatArray, FloatArray]:
    """Corners of the map from the polished result's frames to the new one's, of a property that is
    not owned: its keys stayed, or went with the body, whichever is nearer to what there is."""
    old = place.polish.time
    corners = np.union1d(old.result, old.to_result(place.time.recorded))
    went = place.time.to_result(old.to_recorded(corners))
    missed = [
        _missed(offset, place.new, before.samples, corners, there) for there in (corners, went)
    ]
    return corners, corners if missed[0] < missed[1] else went


def _missed(
    offset: HandOffset, new: CurveSamples, was: CurveSamples, one: FloatArray, other: FloatArray
) -> float:
    """By how much a property that was written is not what there is now, its frames mapped."""
    there = mapped(was.frames, one, other)
    inside = (there >= new.frames[0]) & (there <= new.frames[-1])
    apart = [0.0]
    for index in offset.indices if inside.any() else ():
        default = default_of((offset.path, index))
        values = was.at((offset.path, index), was.frames[inside], default)
        apart.append(np.abs(new.at((offset.path, index), there[inside], default) - values).max())
    return float(max(apart))


def _copied(
    holder: fcurves.CurveHolder,
    source: fcurves.CurveHolder | None,
    offset: HandOffset,
    place: PlacedPolish,
    before: Written,
) -> bool:
    """Give a property the edited keys, in their new places; False where that is not all there is
    to its curves, or the new result lacks some of the frames."""
    found = [source.fcurves.find(offset.path, index=i) for i in offset.indices] if source else []
    curves = [curve for curve in found if curve is not None]
    if not curves or any(len(curve.modifiers) for curve in curves):
        return False
    moved = _moved_alone(offset, place, before)
    first, last = mapped(np.array(key_span(curves)), *moved)
    if first < place.new.frames[0] - 1.0 or last > place.new.frames[-1] + 1.0:
        return False
    for curve in curves:
        keys = fcurves.table(curve)
        for name in ("co", "handle_left", "handle_right"):
            keys[name][:, 0] = mapped(keys[name][:, 0].astype(float), *moved)
        made = fcurves.ensured(
            holder, curve.data_path, curve.array_index, fcurves.bone_of(offset.path) or ""
        )
        made.extrapolation = curve.extrapolation
        for modifier in list(made.modifiers):
            made.modifiers.remove(modifier)
        fcurves.put(made, keys)
    return True
