"""A result's curves as they were written, kept with it: later edits are told from them."""

from __future__ import annotations

from dataclasses import dataclass
from io import BytesIO

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ..armature import fcurves
from ..takes.difference import difference_shown
from ..takes.key_splice import key_span
from ..takes.take_time import TakeTime

Channel = tuple[str, int]  # a curve's path and index

_WRITTEN = "hangtime_written"


@dataclass(frozen=True)
class CurveSamples:
    """Curves at whole frames (T,), one after the other: values (T,) by channel."""

    frames: FloatArray
    values: dict[Channel, FloatArray]

    def at(self, channel: Channel, frames: FloatArray, default: float) -> FloatArray:
        """(N,) values at frames (N,), held beyond the ends; of a channel without a curve the
        default."""
        values = self.values.get(channel)
        if values is None:
            return np.full(len(frames), default)
        return np.asarray(np.interp(frames, self.frames, values))


@dataclass(frozen=True)
class Written:
    """What a result was when it was made, without any hand polish.

    time: where the take's frames are in it. adapted: first and last frame of the take that were
    adapted.
    """

    samples: CurveSamples
    time: TakeTime
    adapted: tuple[float, float]


def edited_action(result: bpy.types.Action) -> bpy.types.Action:
    """The action in which a result is edited by hand: its own, or its difference from the take."""
    return difference_shown(result) or result


def sampled(action: bpy.types.Action, slot: str | None) -> CurveSamples:
    """The curves of an action's slot over all of its keys. Muted ones count as if not there."""
    holder = fcurves.holder_in(action, slot)
    curves = [c for c in holder.fcurves if not c.mute] if holder is not None else []
    curves = [curve for curve in curves if len(curve.keyframe_points)]
    if not curves:
        return CurveSamples(np.empty(0), {})
    first, last = key_span(curves)
    frames = np.arange(np.floor(first), np.ceil(last) + 1.0)
    values = {(curve.data_path, curve.array_index): _values(curve, frames) for curve in curves}
    return CurveSamples(frames, values)


def _values(curve: bpy.types.FCurve, frames: FloatArray) -> FloatArray:
    keys = fcurves.keys(curve)
    if not len(curve.modifiers) and np.array_equal(keys[:, 0], frames):
        return keys[:, 1]
    values = map(curve.evaluate, frames.tolist())
    return np.fromiter(values, np.float32, len(frames)).astype(float)


def keep_written(result: bpy.types.Action, written: Written) -> None:
    """Store what a result was when it was made with its action."""
    channels = list(written.samples.values)
    stream = BytesIO()
    np.savez_compressed(
        stream,
        frames=written.samples.frames,
        paths=np.array([path for path, _ in channels], dtype=np.str_),
        indices=np.array([index for _, index in channels], dtype=int),
        values=np.array([written.samples.values[each] for each in channels], np.float32),
        recorded=written.time.recorded,
        result=written.time.result,
        adapted=np.array(written.adapted),
    )
    if result.get(_WRITTEN) is not None:  # Blender would cut bytes that replace others off
        del result[_WRITTEN]
    result[_WRITTEN] = stream.getvalue()


def written_of(result: bpy.types.Action) -> Written | None:
    """What `keep_written` stored with a result; None of those that earlier versions made."""
    stored = result.get(_WRITTEN)
    if stored is None:
        return None
    with np.load(BytesIO(stored), allow_pickle=False) as packed:
        channels = zip(packed["paths"].tolist(), packed["indices"].tolist(), strict=True)
        values = dict(zip(channels, packed["values"].astype(float), strict=True))
        first, last = packed["adapted"].tolist()
        time = TakeTime(packed["recorded"], packed["result"])
        return Written(CurveSamples(packed["frames"], values), time, (first, last))
