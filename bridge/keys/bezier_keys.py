"""Bézier keys in F-curves."""

from __future__ import annotations

import numpy as np

from ...solver.arrays import FloatArray
from ..armature.fcurves import CurveHolder, KeyTable, ensured, joined, linear_keys, put, table
from .bezier import AFTER, BEFORE, BezierKeys

_BEZIER, _ALIGNED, _EXTREME = 2, 3, 1  # values of Blender's enums
_EPSILON = 1e-4  # frames
_NEAREST = 0.5  # frames between an event and the key that shows it


def splice_bezier(
    curves: CurveHolder, path: str, keys: BezierKeys, extremes: FloatArray, group: str
) -> None:
    """Replace the keys of the curves of `path`, a column of values each, from the first to the last
    of the new ones, both included. All others stay, bit by bit.

    Handles are aligned, each of its own length. extremes: frames (n,), whole
    or not; the keys nearest to them are marked as extremes.
    """
    first, last = keys.frames[0] - _EPSILON, keys.frames[-1] + _EPSILON
    for index in range(keys.values.shape[1]):
        curve = ensured(curves, path, index, group)
        old = table(curve)
        outside = (old["co"][:, 0] < first) | (old["co"][:, 0] > last)
        kept = {name: column[outside] for name, column in old.items()}
        put(curve, joined(kept, _bezier_keys(kept, keys, index, extremes)))


def _bezier_keys(like: KeyTable, keys: BezierKeys, index: int, extremes: FloatArray) -> KeyTable:
    """Keys of one channel. like: a table of the same columns."""
    frames, values, slopes = keys.frames, keys.values[:, index], keys.slopes[:, index]
    gaps = np.diff(frames)
    made = linear_keys(like, frames, values)
    for side, name, reach in (
        (-1.0, "handle_left", np.append(gaps[:1], gaps) * keys.parameters[:, index, BEFORE]),
        (1.0, "handle_right", np.append(gaps, gaps[-1:]) * keys.parameters[:, index, AFTER]),
    ):
        made[name][:] = np.column_stack([frames + side * reach, values + side * reach * slopes])
        made[f"{name}_type"][:] = _ALIGNED
    made["interpolation"][:] = _BEZIER
    if len(extremes):
        near = np.abs(frames[:, None] - extremes).min(axis=1) <= _NEAREST
        made["type"][near] = _EXTREME
    return made
