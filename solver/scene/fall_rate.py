"""The frame rate at which a body that nothing carries falls as gravity has it."""

from __future__ import annotations

from math import isclose

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from ..arrays import BoolArray, FloatArray
from ..data.constants import STANDARD_GRAVITY

_WHOLE_RATES = (12, 15, 24, 25, 30, 48, 50, 60, 72, 90, 100, 120, 144, 200, 240)
_NTSC = 1000.0 / 1001.0  # times a whole rate: 23.976, 29.97
_SAME = 3e-4  # relative, of rates; clips round their frame time
NEAR = 0.12  # of a usual rate; an acceleration errs by twice that, which limbs that swing explain
LEAST_INSTANTS = 6
ROUGH = 0.1  # of the path's height, by which it may miss a parabola (rms)
WINDOW = 0.1  # s, over which an acceleration of a body that is carried can be told
PULLED = 0.1  # of those windows; honest runs and jumps have none, a walk at twice its rate 0.2


def usual_rates(rate: float) -> tuple[float, ...]:
    """Rates, Hz, that a scene or recording of a rate, Hz, may be meant to have: whole ones, or
    NTSC's beside NTSC's."""
    ntsc = any(isclose(rate, _NTSC * whole, rel_tol=_SAME) for whole in _WHOLE_RATES)
    return tuple((_NTSC if ntsc else 1.0) * whole for whole in _WHOLE_RATES)


def fitting_rate(times: FloatArray, heights: FloatArray, rate: float) -> float | None:
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
    usual = min(usual_rates(rate), key=lambda each: abs(np.log(each / wanted)))
    near = abs(usual / wanted - 1.0) < NEAR
    return usual if near and abs(usual / rate - 1.0) > NEAR else None


def is_pulled_down(times: FloatArray, heights: FloatArray, carried: BoolArray) -> bool:
    """Whether the centre of mass at heights (T,), m, at instants (T,), s, falls faster than gravity
    has it in a good part of the time in which something carries it, (T,).

    Nothing that carries pulls, so these times are then not those of the motion: where one foot of a
    walk floats its hips seem to fly, and at a rate at which they would fall they do so all along.
    """
    step = float(times[-1] - times[0]) / (len(times) - 1)
    count = max(LEAST_INSTANTS, round(WINDOW / step))
    if len(times) < count:
        return False
    whole = sliding_window_view(carried, count).all(axis=1)
    curvature = np.polyfit(step * np.arange(count), np.eye(count), 2)[0]
    falls = -2.0 * sliding_window_view(heights, count)[whole] @ curvature
    return bool(falls.size and np.mean(falls > STANDARD_GRAVITY) > PULLED)
