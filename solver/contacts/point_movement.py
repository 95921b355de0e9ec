"""Movement of points at even instants, whatever the frame rate: tracks, velocities, differences."""

from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from ..data.contacts import ContactPoint
from ..numerics.interpolation import interpolate

STEP = 0.005  # s; tracks are looked at so finely
MAX_SLIDE = 0.06  # m; a point that slides further makes a new contact
SMOOTHING = 0.01  # s; half of the time over which a speed is taken
HALF = round(SMOOTHING / STEP)


@dataclass(frozen=True)
class PointMovement:
    """Movement of a point at N even instants.

    track: (N, 3) m, and velocity: (N, 3) m/s, of the part that presses. point: (N, 3) m.
    """

    track: FloatArray
    velocity: FloatArray
    point: FloatArray

    def part(self, start: int, stop: int) -> "PointMovement":
        """Of the instants from `start` to `stop`, without that."""
        inside = slice(start, stop)
        return PointMovement(self.track[inside], self.velocity[inside], self.point[inside])


def even_clock(start: float, end: float) -> FloatArray:
    """(N,) instants from `start` to `end`, s, STEP apart or very nearly so."""
    return np.linspace(start, end, max(2 * HALF, round((end - start) / STEP)) + 1)


def point_movement(times: FloatArray, point: ContactPoint, clock: FloatArray) -> PointMovement:
    """Movement of a point that is recorded at `times` (T,) s, at the instants `clock` (N,) s.

    The velocity is the mean over 2 SMOOTHING, or what is left of it at the clip's ends.
    """
    before = np.maximum(clock - SMOOTHING, clock[0])
    after = np.minimum(clock + SMOOTHING, clock[-1])
    pressing = point.track if point.pressing is None else point.pressing
    moved = interpolate(times, pressing, after) - interpolate(times, pressing, before)
    return PointMovement(
        interpolate(times, pressing, clock),
        moved / (after - before)[:, None],
        interpolate(times, point.track, clock),
    )


def rate(samples: FloatArray) -> FloatArray:
    """(N,) first derivative, 1/s, of samples (N,) STEP apart: central; 0 at the clip's ends."""
    return np.pad((samples[2 * HALF :] - samples[: -2 * HALF]) / (2.0 * SMOOTHING), HALF)


def acceleration(samples: FloatArray, frame_time: float) -> FloatArray:
    """(N,) second derivative, 1/s², of samples (N,) STEP apart: central; 0 at the clip's ends.

    frame_time: s, of the recording. Over much less than it samples tell how they were interpolated,
    as they bend at frames: so it is taken over about a frame to each side, within half of STEP.
    """
    half = max(HALF, round(frame_time / STEP))
    if len(samples) <= 2 * half:
        return np.zeros_like(samples)
    bend = samples[2 * half :] - 2.0 * samples[half:-half] + samples[: -2 * half]
    return np.pad(bend / (half * STEP) ** 2, half)
