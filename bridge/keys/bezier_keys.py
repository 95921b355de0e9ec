"""Bézier keys in F-curves, whose handles make them the cubics of `hermite`."""

from __future__ import annotations

import numpy as np

from ...solver.arrays import FloatArray
from ..armature.fcurves import CurveHolder, KeyTable, ensured, joined, linear_keys, put, table
from .hermite import HermiteKeys

_BEZIER, _ALIGNED, _EXTREME = 2, 3, 1  # values of Blender's enums
_EPSILON = 1e-4  # frames
_NEAREST = 0.5  # frames between an event and the key that shows it


def splice_bezier(
    curves: CurveHolder, path: str, keys: HermiteKeys, extremes: FloatArray, group: str
) -> None:
    """Replace the keys of the curves of `path`, a column of values each, from the first to the last
    of the new ones, both included. All others stay, bit by bit.

    Handles are aligned and reach a third of the way to the next key. extremes: frames (n,), whole
    or not; the keys nearest to them are marked as extremes.
    """
    first, last = keys.frames[0] - _EPSILON, keys.frames[-1] + _EPSILON
    for index in range(keys.values.shape[1]):
        curve = ensured(curves, path, index, group)
        old = table(curve)
        outside = (old["co"][:, 0] < first) | (old["co"][:, 0] > last)
        kept = {name: column[outside] for name, column in old.items()}
        put(curve, joined(kept, _bezier_keys(kept, keys, index, extremes)))


def _bezier_keys(like: KeyTable, keys: HermiteKeys, index: int, extremes: FloatArray) -> KeyTable:
    """Keys of one channel. like: a table of the same columns."""
    frames, values, slopes = keys.frames, keys.values[:, index], keys.slopes[:, index]
    spans = np.diff(frames) / 3.0
    made = linear_keys(like, frames, values)
    for side, name, reach in (
        (-1.0, "handle_left", np.append(spans[:1], spans)),
        (1.0, "handle_right", np.append(spans, spans[-1:])),
    ):
        made[name][:] = np.column_stack([frames + side * reach, values + side * reach * slopes])
        made[f"{name}_type"][:] = _ALIGNED
    made["interpolation"][:] = _BEZIER
    if len(extremes):
        near = np.abs(frames[:, None] - extremes).min(axis=1) <= _NEAREST
        made["type"][near] = _EXTREME
    return made
