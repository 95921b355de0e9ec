"""Treadmills: feet that slide along the floor at one steady speed while they stand."""

from collections.abc import Mapping

import numpy as np

from ..arrays import FloatArray
from ..data.contacts import ContactPoint, PointKind

LOW_SHARE = 20.0  # %; a toe is on the ground that long at least in a walk or a run
MIN_SPEED = 0.5  # m/s
STEADY = 0.2  # of the speed, by which most frames may differ from it


def belt_speed(times: FloatArray, points: Mapping[str, ContactPoint]) -> float | None:
    """Speed, m/s, at which the toes slide while they are lowest; None where it is not steady.

    times: (T,) s. points: by name, as from `contact_points`.
    """
    slides = []
    for point in points.values():
        if point.kind is PointKind.TOE:
            height = point.track[:, 2]
            velocity = np.gradient(point.track[:, :2], times, axis=0)
            # Feet that were locked to a floor are at one height throughout: none would be below it.
            slides.append(velocity[height <= np.percentile(height, LOW_SHARE)])
    slide = np.concatenate(slides)
    steady = np.median(slide, axis=0)
    speed = float(np.linalg.norm(steady))
    apart = float(np.median(np.linalg.norm(slide - steady, axis=1)))
    return speed if speed > MIN_SPEED and apart < STEADY * speed else None
