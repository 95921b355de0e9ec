"""Which way is down: whoever is in the air falls that way, whatever the floor below slopes like.

A centre of mass in flight has the acceleration of gravity, also in its direction: 0.4 s of a flight
tell the vertical to half a degree, at 24 frames a second to one. What a flight is must not hang on
a level floor then: it is where the acceleration stays as large and goes one way.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, radians, sin

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from ..analysis.performance import Performance
from ..arrays import FloatArray
from ..data.constants import STANDARD_GRAVITY
from ..numerics.rotations import angles_between
from ..numerics.runs import runs

WINDOW = 0.1  # s, of the parabolas by which acceleration is told from frame to frame
FEWEST = 4  # frames, whose velocities have a slope and something that is off it
SHORTEST = 0.3  # s; of shorter falls too much is in touch
SIZES = (0.8, 1.25)  # of gravity, that of a fall by such a parabola
LEANING = cos(radians(45.0))  # a figure has been stood up by then: the next axis is no nearer
ONE_WAY = sin(radians(25.0))  # of a fall's mean acceleration, that any of it misses it by
# Of the slope, one standard deviation, by masses of limbs that are not known: as good as alike in
# all falls of a figure, so that several tell it no better. 0.4 s tell it to 0.4°, and shorter ones
# as velocities' slopes do.
OFF, OFF_AT = radians(0.4), 0.4  # s
# Of who turns in flight the centre of mass seems to go around the true one: tables of masses differ
# by so much. About whole turns at one rate it is a velocity whose slope is 12 / s² of that.
APART, TURNS = 0.005, 12.0  # m
SURE = 4.0  # times what it is unsure by, by which down is elsewhere: in clean clips up to 1.6
ALIKE = 3.0  # times what a fall is unsure by, that it may miss the others; what sways does by more


@dataclass(frozen=True)
class Plumb:
    """slope: (2,) that a floor has which is level, upwards along x and y. unsure: of each of the
    two, one standard deviation. falls: how many tell it."""

    slope: FloatArray
    unsure: float
    falls: int

    @property
    def is_sloping(self) -> bool:
        """Whether down is surely not where the recording has it."""
        return float(np.linalg.norm(self.slope)) > SURE * self.unsure

    def is_along(self, slope: FloatArray) -> bool:
        """Whether a floor of a slope (2,) is nearer to level by it than one that seems level."""
        return float(np.linalg.norm(self.slope - slope)) < float(np.linalg.norm(self.slope))

    def agrees(self, slope: FloatArray) -> bool:
        """Whether a floor of a slope (2,) may be level by it."""
        return float(np.linalg.norm(self.slope - slope)) < ALIKE * self.unsure


def find_plumb(performance: Performance) -> Plumb | None:
    """What the falls of a recording tell together; None where there are none, or they differ.

    performance: in its right size and time.
    """
    found = [_fall(performance, frames) for frames in _falls(performance)]
    if not found:
        return None
    slopes = np.array([each.slope for each in found])
    unsure = np.array([each.unsure for each in found])
    weights = unsure**-2
    mean = np.asarray(weights @ slopes / weights.sum())
    if not all(each.agrees(mean) for each in found):
        return None
    return Plumb(mean, float(unsure.min()), len(found))


def _falls(performance: Performance) -> list[slice]:
    """Frames of each."""
    rate, com = performance.recording.rate, performance.com
    half = max(round(0.5 * WINDOW * rate), 2)
    if len(com) <= 2 * half:
        return []
    since = np.arange(-half, half + 1) / rate
    second = 2.0 * np.linalg.pinv(np.vander(since, 3))[0]
    acceleration = sliding_window_view(com, len(since), axis=0) @ second
    size = np.linalg.norm(acceleration, axis=1)
    low, high = (each * STANDARD_GRAVITY for each in SIZES)
    falls = (size > low) & (size < high) & (-acceleration[:, 2] > LEANING * size)
    found = []
    for first, last in runs(falls):
        within = acceleration[first : last + 1]
        mean = within.mean(axis=0)
        near = np.linalg.norm(within - mean, axis=1) < ONE_WAY * np.linalg.norm(mean)
        for a, b in runs(near):
            # A parabola that is half in touch is none: the inner halves of the outer ones count.
            frames = slice(first + a + half // 2, first + b + 2 * half - half // 2 + 1)
            if frames.stop - frames.start > max(SHORTEST * rate, FEWEST):
                found.append(frames)
    return found


def _fall(performance: Performance, frames: slice) -> Plumb:
    """What one tells: by the slope of velocities, whose errors are independent, as those of places
    are not."""
    times, com = performance.times[frames], performance.com[frames]
    velocity = np.diff(com, axis=0) / np.diff(times)[:, None]
    middles = 0.5 * (times[1:] + times[:-1])
    since = middles - middles.mean()
    spread = float(since @ since)
    acceleration = since @ velocity / spread
    left = velocity - velocity.mean(axis=0) - np.outer(since, acceleration)
    deviation = np.sqrt(np.mean(left[:, :2] ** 2) * len(since) / (len(since) - 2) / spread)
    seconds = float(np.ptp(times))
    off = OFF * (OFF_AT / seconds) ** 1.5
    around = APART * min(_turning(performance, frames) ** 2, TURNS / seconds**2)
    unsure = float(np.linalg.norm([off, deviation / STANDARD_GRAVITY, around / STANDARD_GRAVITY]))
    return Plumb(acceleration[:2] / -acceleration[2], unsure, falls=1)


def _turning(performance: Performance, frames: slice) -> float:
    """Rad/s, at which the pelvis turns in the mean."""
    pelvis = performance.rotations[frames, 0]
    return float(angles_between(pelvis[:-1], pelvis[1:]).mean() * performance.recording.rate)
