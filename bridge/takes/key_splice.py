"""Keys of a curve replaced between two frames; all others stay, bit by bit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from ...solver.arrays import FloatArray
from ..armature import fcurves
from ..armature.fcurves import KeyTable, joined, linear_keys, put, table
from .switches import EPSILON, MOST_STEPS, on_whole_frames, switched
from .take_time import TakeTime

FEWEST_BAKED = 4  # keys side by side; two or three are a blink or a switch
_CONSTANT = 0  # values of Blender's enums
_FREE = 0
_BEZIER = 2
_ALIGNED = 3


def retime(curve: bpy.types.FCurve, time: TakeTime) -> None:
    """Move keys and handles to where the take's frames are in the result.

    Keys outside of the frames whose durations changed take their handles along as they are. A curve
    with a key on every one of these, as of a recording, gets keys of what it shows on every frame.
    A switch from one whole frame to the next stays one.
    """
    keys = table(curve)
    at = keys["co"][:, 0].copy()
    before, after = at <= time.recorded[0], at >= time.recorded[-1]
    whole = _whole_frames(at, time) if _is_baked(curve, keys, ~(before | after)) else np.empty(0)
    shown = np.array([curve.evaluate(f) for f in _seen(curve, time.to_recorded(whole))])
    moved = on_whole_frames(at, keys["co"][:, 1], time) - time.to_result(at)
    for name in ("co", "handle_left", "handle_right"):
        frames = keys[name][:, 0].copy()
        keys[name][:, 0] = np.where(after, frames + time.later, time.to_result(frames) + moved)
        keys[name][before, 0] = frames[before]
    put(curve, keys)
    if len(shown):
        ends = float(time.result[0]), float(time.result[-1])
        splice(curve, whole, shown, ends, FullTurns())


def _seen(curve: bpy.types.FCurve, frames: FloatArray) -> FloatArray:
    """The take's frames (T,) of which a baked curve's values are shown: the nearest whole one
    where it is switched, which it is half of nowhere. Of a motion that begins or ends beside them
    so much is looked at that it is seen to be none."""
    if not len(frames):
        return frames
    beside = MOST_STEPS + 1
    around = np.arange(np.floor(frames[0]) - beside, np.ceil(frames[-1]) + beside + 1.0)
    thrown = switched(np.array([curve.evaluate(f) for f in around]))
    interval = (np.floor(frames) - around[0]).astype(int)
    return np.where(thrown[interval], np.round(frames), frames)


def _is_baked(curve: bpy.types.FCurve, keys: KeyTable, changed: NDArray[np.bool_]) -> bool:
    """Whether keys are on every whole frame among those whose place in time changes, and beside
    them, none held; and nothing comes on top."""
    inside = np.flatnonzero(changed)
    if len(inside) < FEWEST_BAKED or len(curve.modifiers):
        return False
    at = keys["co"][max(inside[0] - 1, 0) : inside[-1] + 2, 0]
    whole = bool(np.abs(at - np.round(at)).max() < EPSILON)
    each = whole and bool(np.diff(at).max() < 1.0 + EPSILON)
    return each and bool((keys["interpolation"][changed] != _CONSTANT).all())


def _whole_frames(at: FloatArray, time: TakeTime) -> FloatArray:
    """Of a result, where durations changed, as far as keys at a take's frames (n,) go: to the frame
    that shows the first, or the last, where the take goes on beyond it."""
    first, last = time.to_result(at[[0, -1]]).tolist()
    last = np.ceil(last - EPSILON) if at[-1] < time.recorded[-2] else np.floor(last + EPSILON)
    begin = max(np.floor(first + EPSILON), np.ceil(time.result[0] - EPSILON))
    return np.arange(begin, min(last, np.floor(time.result[-1] + EPSILON)) + 1.0)


@dataclass(frozen=True)
class FullTurns:
    """What full turns of the new keys make of the values after them: a factor and a summand."""

    factor: float = 1.0
    summand: float = 0.0

    @property
    def none(self) -> bool:
        """Whether the values stay, bit by bit."""
        return self.factor == 1.0 and self.summand == 0.0

    def of(self, values: NDArray[Any]) -> NDArray[Any]:
        """Values of the same rotation."""
        return np.asarray(self.factor * values + self.summand)


def splice(
    curve: bpy.types.FCurve,
    frames: FloatArray,
    values: FloatArray,
    between: tuple[float, float],
    turns: FullTurns,
) -> None:
    """Replace the keys strictly between two frames by linear ones of values at frames (T,).

    The values at the two frames themselves count where the curve has no key on that side. Where
    the nearest keys are further off, whole frames up to them get keys of the curve's own values.
    """
    keys = table(curve)
    at = keys["co"][:, 0].astype(float)
    first, last = between
    before, after = at <= first + EPSILON, at >= last - EPSILON
    new = frames > first + EPSILON if before.any() else frames >= first - EPSILON
    new &= frames < last - EPSILON if after.any() else frames <= last + EPSILON
    left, right = _gap_frames(at, before, after, between)
    shown = [np.array([curve.evaluate(f) for f in gap]) for gap in (left, right)]
    made = linear_keys(
        keys,
        np.concatenate([left, frames[new], right]),
        np.concatenate([shown[0], values[new], turns.of(shown[1])]),
    )
    head, tail = _part(keys, before), _part(keys, after)
    if not turns.none:
        for name in ("co", "handle_left", "handle_right"):
            tail[name][:, 1] = turns.of(tail[name][:, 1])
    _keep_tangents(head, -1)
    _keep_tangents(tail, 0)
    put(curve, joined(joined(head, made), tail))


def anchor(
    curve: bpy.types.FCurve,
    between: tuple[float, float],
    beside: tuple[float | None, float | None],
    rest: float,
) -> None:
    """Key what a curve shows at a frame beside those that are replaced strictly between two, on a
    side where it has no key: there it would hold the first or last new value.

    beside: None where nothing is to be kept. rest: what the channel is while the curve has no key.
    """
    keys = table(curve)
    at = keys["co"][:, 0]
    keyed = (at <= between[0] + EPSILON).any(), (at >= between[1] - EPSILON).any()
    frames = np.array(
        [f for f, has in zip(beside, keyed, strict=True) if f is not None and not has]
    )
    if len(frames):
        values = np.array([curve.evaluate(f) if len(at) else rest for f in frames])
        put(curve, joined(keys, linear_keys(keys, frames, values)))


def applied(curve: bpy.types.FCurve, frames: FloatArray, constant: float | None) -> None:
    """Make a curve keys of what it does at frames (T,): without modifiers, and not muted.

    constant: what a muted curve's channel is instead; None where it is not muted.
    """
    values = np.array([curve.evaluate(f) if constant is None else constant for f in frames])
    for modifier in list(curve.modifiers):
        curve.modifiers.remove(modifier)
    curve.mute = False
    put(curve, linear_keys(table(curve), frames, values))


def _gap_frames(
    at: FloatArray,
    before: NDArray[np.bool_],
    after: NDArray[np.bool_],
    between: tuple[float, float],
) -> tuple[FloatArray, FloatArray]:
    """Whole frames between the two and the nearest keys outside, these two included."""
    left = right = np.empty(0)
    first, last = between
    if before.any() and at[before].max() < first - EPSILON:
        nearest = np.floor(at[before].max() + EPSILON)
        left = np.arange(nearest + 1.0, np.floor(first + EPSILON) + 1.0)
    if after.any() and at[after].min() > last + EPSILON:
        nearest = np.ceil(at[after].min() - EPSILON)
        right = np.arange(np.ceil(last - EPSILON), nearest)
    return left, right


def _part(keys: KeyTable, chosen: NDArray[np.bool_]) -> KeyTable:
    return {name: column[chosen] for name, column in keys.items()}


def _keep_tangents(keys: KeyTable, index: int) -> None:
    """Keep automatic handles of the key beside the new ones as they are when somebody edits the
    curve: Blender works them out from both neighbours."""
    if not len(keys["co"]) or int(keys["interpolation"][index, 0]) != _BEZIER:
        return
    types = [f"{name}_type" for name in ("handle_left", "handle_right")]
    if any(int(keys[name][index, 0]) not in (_FREE, _ALIGNED) for name in types):
        for name in types:
            keys[name][index] = _FREE


def key_span(curves: list[bpy.types.FCurve]) -> tuple[float, float]:
    """First and last frame that has a key of any of these curves; at least one has keys."""
    spans = np.array([fcurves.keys(c)[[0, -1], 0] for c in curves if len(c.keyframe_points)])
    return float(spans[:, 0].min()), float(spans[:, 1].max())
