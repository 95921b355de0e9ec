"""Hips whose way along the floor was left out, as exports “in place” have it, or that stay where
they are above a treadmill's belt: the feet that carry slide backwards below them."""

from __future__ import annotations

import numpy as np

from ...analysis.performance import Performance, contact_points
from ...arrays import BoolArray, FloatArray
from ...numerics.runs import runs
from ...scene.belt import belt_speed
from ..finding import Finding, FindingKind
from ..local_poses import spans
from ..repairs import Repairs
from .footing import DRIFT, LEAST_STANDING, LowestPoint, standing

KEPT = 0.005  # m along the way, by which hips that keep their place leave it; nobody's stay so
KEPT_SHARE = 0.1  # of the way that the feet tell: hips above a belt go to and fro by less
LEAST_WAY = 0.3  # m that the feet tell
STEP = 0.2  # s; from one place in which a foot slides to the next, told as one


def find_in_place(performance: Performance) -> Finding | None:
    """Feet that go a way while they stand of which the hips go nothing, or, where the feet slide at
    one steady speed, next to nothing. That speed is the remedy; no other way is known.

    performance: as seen from what it stands on, in its right size and time.
    """
    stood = standing(performance)
    if len(stood.times) < LEAST_STANDING:
        return None
    way = _way_of_the_ground(stood, performance.times)
    far = float(np.linalg.norm(way))
    if far < LEAST_WAY:
        return None
    left = float(np.ptp(performance.centres[:, 0, :2] @ (way / far)))
    steady = belt_speed(performance.times, contact_points(performance)[0]) is not None
    speeds = np.linalg.norm(stood.velocities[:, :2], axis=1)
    slides = speeds > DRIFT
    if left > max(KEPT, KEPT_SHARE * far if steady else 0.0) or not slides.any():
        return None
    x, y = np.median(stood.velocities[:, :2], axis=0).tolist()
    remedy = Repairs(drift=(x, y)) if steady else None  # a jump's way is in flight: not told
    sliding = np.isin(performance.times, stood.times[slides])
    places = spans(performance.recording, _joined(sliding, performance.recording.rate))
    speed = float(np.median(speeds[slides]))
    return Finding(FindingKind.IN_PLACE, speed, "m/s", places, remedy=remedy)


def _joined(sliding: BoolArray, rate: float) -> BoolArray:
    """(T,) where feet slide, and in between from a step to the next. rate: frames a second."""
    joined = sliding.copy()
    for first, last in runs(~sliding):
        if first > 0 and last < len(sliding) - 1 and last - first < STEP * rate:
            joined[first : last + 1] = True
    return joined


def _way_of_the_ground(stood: LowestPoint, times: FloatArray) -> FloatArray:
    """(2,) m, along the floor, by the velocities of what stands, and between stances by those
    before and after. times: (T,) s."""
    velocities = [np.interp(times, stood.times, stood.velocities[:, axis]) for axis in (0, 1)]
    middles = 0.5 * (np.array(velocities)[:, 1:] + np.array(velocities)[:, :-1])
    return np.asarray(middles @ np.diff(times))
