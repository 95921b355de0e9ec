"""Derivatives of noisy samples by local regression (Savitzky & Golay 1964; Cleveland 1979)."""

from math import factorial

import numpy as np

from ..arrays import FloatArray

# Of the polynomial, by derivative; next to an end the curvature of a cubic is mostly noise.
DEGREE = {1: 3, 2: 2}
REACH = 4.0  # standard deviations of the Gaussian weight, to either side


def derivative(
    times: FloatArray, samples: FloatArray, at: FloatArray, width: float, order: int
) -> FloatArray:
    """(N, n) first or second derivative of samples (T, n), by s or s², at instants (N,) s.

    A polynomial is fitted to the samples around each instant, with Gaussian weights of standard
    deviation `width`, s. times: (T,) s, evenly spaced, T at least 4; near the ends one side serves.
    A parabola's second derivative is a cubic's where both sides serve.
    """
    degree = DEGREE[order]
    frame = float(times[-1] - times[0]) / (len(times) - 1)
    count = min(len(times), 2 * max(int(np.ceil(REACH * width / frame)), degree) + 1)
    first = np.clip(np.searchsorted(times, at) - count // 2, 0, len(times) - count)
    index = first[:, None] + np.arange(count)
    u = (times[index] - at[:, None]) / width
    root = np.exp(-0.25 * u**2)  # of the weight
    powers = u[..., None] ** np.arange(degree + 1)
    fitted = factorial(order) / width**order * np.linalg.pinv(root[..., None] * powers)[:, order]
    return np.asarray(np.einsum("nk,nkj->nj", root * fitted, samples[index]))
