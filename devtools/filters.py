"""Filter of forces that are compared, and plain differentiation, which they are compared with."""

import numpy as np
from scipy.signal import butter, filtfilt

from ..solver.arrays import FloatArray
from ..solver.data.constants import STANDARD_GRAVITY

ORDER = 2  # of the Butterworth filter, which is run both ways (Winter 2009, 2.2.4.4)
CUT_OFFS = (10.0, 15.0, 20.0)  # Hz


def low_pass(samples: FloatArray, rate: float, cut_off: float) -> FloatArray:
    """Samples (T, ...) at `rate` Hz without what is faster than `cut_off` Hz, without delay."""
    numerator, denominator = butter(ORDER, cut_off / (rate / 2.0))
    return np.asarray(filtfilt(numerator, denominator, samples, axis=0))


def differentiated(com: FloatArray, rate: float) -> FloatArray:
    """(T, 3) contact force in body weights that a centre of mass (T, 3) m at `rate` Hz tells.

    Newton's second law by central differences, twice. Forward, left, up.
    """
    velocity = np.gradient(com, 1.0 / rate, axis=0)
    acceleration = np.gradient(velocity, 1.0 / rate, axis=0)
    return np.asarray(acceleration / STANDARD_GRAVITY + np.array([0.0, 0.0, 1.0]))


def resampled(times: FloatArray, samples: FloatArray, at: FloatArray) -> FloatArray:
    """(U, ...) linear interpolation of samples (T, ...) at instants (U,) s."""
    flat = samples.reshape(len(times), -1)
    columns = [np.interp(at, times, flat[:, k]) for k in range(flat.shape[1])]
    return np.stack(columns, axis=1).reshape(len(at), *samples.shape[1:])
