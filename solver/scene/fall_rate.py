"""The frame rate at which a body that nothing carries falls as gravity has it."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..data.constants import STANDARD_GRAVITY

USUAL_RATES = (12, 15, 24, 25, 30, 48, 50, 60, 72, 90, 100, 120, 144, 200, 240)
NEAR = 0.12  # of a usual rate; an acceleration errs by twice that, which limbs that swing explain
LEAST_INSTANTS = 6
ROUGH = 0.1  # of the path's height, by which it may miss a parabola (rms)


def fitting_rate(times: FloatArray, heights: FloatArray, rate: float) -> int | None:
    """The usual rate, Hz, at which the centre of mass at heights (T,), m, falls freely.

    times: (T,) s by the scene's rate, Hz, at which the frames were taken to follow each other. None
    where the path is no parabola, or fits the scene's rate, or none that is usual.
    """
    if len(times) < LEAST_INSTANTS:
        return None
    curve = np.polyfit(times - times[0], heights, 2)
    fall = -2.0 * float(curve[0])
    missed = np.sqrt(np.mean((heights - np.polyval(curve, times - times[0])) ** 2))
    if fall <= 0.0 or missed > ROUGH * np.ptp(heights):
        return None
    wanted = rate * np.sqrt(STANDARD_GRAVITY / fall)
    usual = min(USUAL_RATES, key=lambda each: abs(np.log(each / wanted)))
    near = abs(usual / wanted - 1.0) < NEAR
    return usual if near and abs(usual / rate - 1.0) > NEAR else None
