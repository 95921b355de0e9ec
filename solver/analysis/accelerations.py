"""Velocities and accelerations of a recording: of its joint angles and of its centre of mass."""

import numpy as np

from ..arrays import FloatArray
from ..data.contacts import ContactSchedule
from ..numerics.local_regression import derivative
from .performance import Performance

SMOOTHING_TIME = 0.018  # s; feet strike and knees give way within twice as long
# A level force is a tenth of the vertical one, knows no impact, and is under the same noise.
LEVEL_SMOOTHING_TIME = 0.03  # s
SMOOTHING_FRAMES = 1.2  # where frames are further apart


def smoothing_width(performance: Performance) -> float:
    """Standard deviation, s, of the weights by which accelerations are estimated."""
    return max(SMOOTHING_TIME, SMOOTHING_FRAMES / performance.recording.rate)


def angle_accelerations(performance: Performance, at: FloatArray) -> FloatArray:
    """(N, n_angles) accelerations of the joint angles, rad/s², at instants (N,) s."""
    take, width = performance.take, smoothing_width(performance)
    return derivative(take.times, take.angles, at, width, 2)


def velocities(performance: Performance, at: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(N, 3) m/s of the centre of mass, and (N, n_angles) rad/s, at instants (N,) s."""
    take, width = performance.take, smoothing_width(performance)
    com, angles = (derivative(take.times, of, at, width, 1) for of in (take.com, take.angles))
    return com, angles


def com_acceleration(
    performance: Performance,
    schedule: ContactSchedule,
    at: FloatArray,
    widths: tuple[float, float] | None = None,
) -> FloatArray:
    """(N, 3) acceleration of the centre of mass, m/s², world, at instants (N,) s.

    In flight it is gravity, whatever the recording's noise says. widths: of the smoothing, s, of
    the level and of the vertical part; None for those that the fit is made with.
    """
    take, width = performance.take, smoothing_width(performance)
    level, width = widths or (max(LEVEL_SMOOTHING_TIME, width), width)
    found = np.concatenate(
        [
            derivative(take.times, take.com[:, axes], at, smoothed, 2)
            for axes, smoothed in ((slice(0, 2), level), (slice(2, 3), width))
        ],
        axis=1,
    )
    for flight in schedule.flights:
        found[(at > flight.start) & (at < flight.end)] = [0.0, 0.0, -performance.character.gravity]
    return found
