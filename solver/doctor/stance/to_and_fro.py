"""Feet that go against a drift: what sways or floats to and fro is as fast and as steady while some
of its stances last, and goes back in others, as nothing does that drifts."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...analysis.performance import Performance, contact_points
from ...arrays import FloatArray
from .flat_feet import FLAT_SPEED, LOW, STANDING_SPEED_UP
from .trembling_feet import TREMOR, WINDOW, slopes

AGAINST = 0.08  # m/s, against the drift: noise and feet that roll seldom leave as much
# Of the time in which feet stand: what sways leaves 0.14 to 0.45, of short stances in noise 0.1,
# and drifts of 0.1 m/s and more, in noise as well, leave up to 0.125.
SHARE = 0.13


def go_against(performance: Performance, drift: Sequence[float]) -> bool:
    """Whether feet that stand go the other way too often for a body that drifts.

    performance: as seen from what it stands on. drift: (2,) m/s, that some of them told. All feet
    count that stand either as they are or with the drift taken out: those that go with it alone
    would never tell against it.
    """
    speeds = _speeds_of_lowest(performance)
    slow = FLAT_SPEED + TREMOR
    stands = np.linalg.norm(speeds, axis=1) < slow
    stands |= np.linalg.norm(speeds - drift, axis=1) < slow
    along = speeds[stands] @ drift / np.linalg.norm(drift)
    return bool(np.count_nonzero(along < -AGAINST) >= SHARE * np.count_nonzero(stands))


def _speeds_of_lowest(performance: Performance) -> FloatArray:
    """(N, 2) m/s, along the floor, of the feet's lowest point while it is near the floor."""
    points, floor = contact_points(performance)
    rate = performance.recording.rate
    half = max(round(0.5 * WINDOW * rate), 1)
    tracks = [point.track for point in points.values() if point.kind.is_of_foot]
    heights = np.stack([track[:, 2] for track in tracks])
    lowest = np.argmin(heights, axis=0), np.arange(heights.shape[1])
    velocities = np.stack([slopes(track, half, rate) for track in tracks])[lowest]
    near = heights[lowest] - floor < LOW
    stands = near & (np.abs(velocities[:, 2]) < STANDING_SPEED_UP)
    return np.asarray(velocities[stands, :2])
