"""Keys of channels that repeat: the cubic through every frame whose end goes on into its start."""

from __future__ import annotations

import numpy as np

from ...solver.arrays import FloatArray
from ..keys.bezier import BezierKeys


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
