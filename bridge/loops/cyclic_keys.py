"""Keys of channels that repeat: the cubic through every frame whose end goes on into its start."""

from __future__ import annotations

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ..armature import fcurves
from ..armature.write import remove
from ..keys.bezier import BezierKeys
from ..keys.bezier_keys import splice_bezier


def cyclic_keys(frames: FloatArray, values: FloatArray) -> BezierKeys:
    """Keys at frames (T,), evenly apart, of channels (T, n) that go on from the last value as they
    did from the first.

    The slopes are those of the cubic spline that is twice differentiable everywhere, the seam
    included (de Boor 2001, IV); the solved motion is such a curve between landings.
    """
    count, step = len(frames) - 1, float(frames[1] - frames[0])
    rises = np.diff(values, axis=0)
    each = np.arange(count)
    system = 4.0 * np.eye(count)
    system[each, each - 1] += 1.0
    system[each - 1, each] += 1.0
    slopes = np.linalg.solve(system, 3.0 * (rises + np.roll(rises, 1, axis=0)) / step)
    return BezierKeys.even(frames, values, np.concatenate([slopes, slopes[:1]]))


def write_cyclic(
    curves: fcurves.CurveHolder,
    path: str,
    bone: str,
    frames: FloatArray,
    values: FloatArray,
    *,
    goes_on: bool,
) -> None:
    """Make keys of values (T, n) the only ones of a bone's path. goes_on: with each repetition."""
    remove(curves, path)
    if not goes_on:
        values = np.concatenate([values[:-1], values[:1]])
    splice_bezier(curves, path, cyclic_keys(frames, values), np.empty(0), bone)
    if goes_on:
        for curve in (c for c in curves.fcurves if c.data_path == path):
            repeat(curve, goes_on=True)


def repeat(curve: bpy.types.FCurve, *, goes_on: bool = False) -> None:
    """Let a curve repeat before and after its keys; one that has modifiers stays as it is."""
    if len(curve.modifiers) or len(curve.keyframe_points) < 2:
        return
    cycles = curve.modifiers.new("CYCLES")
    mode = "REPEAT_OFFSET" if goes_on else "REPEAT"
    cycles.mode_before = cycles.mode_after = mode  # type: ignore[attr-defined]
