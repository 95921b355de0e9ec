"""Soles that lie flat: they touch as a whole, or not at all.

Toes may be higher above the ground than heels, which rise in tiptoe, so that flat on a mat of some
centimetres a foot stood on its toes alone, or on one of two. What is below it then is either a
floor that is not level, or something else.
"""

from collections.abc import Mapping

import numpy as np

from ..arrays import FloatArray
from ..scene.support import LEAST_HEIGHT
from .force_timing import other_end
from .point_movement import STEP

FLAT = 0.015  # m, by which heel and toe of a sole that lies flat differ in height
ALIKE = 0.02  # m, by which soles differ that lie on one thing
LEAST_LYING = round(0.1 / STEP)  # instants


def lying(above: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
    """(N,) m for each point, the height of its foot's sole where that lies flat, else NaN; of both
    soles, where they lie side by side, the mean.

    above: (N,) m, heights of points above the ground, by name ("Left heel"); infinite where there
    is none.
    """
    known = {name: np.where(np.isfinite(height), height, np.nan) for name, height in above.items()}
    soles: dict[str, FloatArray] = {}
    for name, height in known.items():
        other = known.get(other_end(name), np.full(len(height), np.nan))
        soles[name] = np.where(np.abs(height - other) < FLAT, 0.5 * (height + other), np.nan)
    return {name: _together(name, soles) for name in soles}


def _together(name: str, soles: Mapping[str, FloatArray]) -> FloatArray:
    """(N,) m, of a sole and the other foot's, where that lies beside it, the mean."""
    side = name.split()[0]
    across = next((sole for other, sole in soles.items() if other.split()[0] != side), soles[name])
    beside = np.abs(soles[name] - across) < ALIKE
    return np.where(beside, 0.5 * (soles[name] + across), soles[name])


def lies_elsewhere(heights: FloatArray) -> bool:
    """Whether a sole lies on something else than the ground. heights: (N,) m, as of `lying`."""
    flat = heights[~np.isnan(heights)]
    return len(flat) >= LEAST_LYING and float(np.median(flat)) >= LEAST_HEIGHT
