"""Local cubic Lagrange interpolation of samples over time."""

import numpy as np

from ..arrays import FloatArray


def interpolate(times: FloatArray, samples: FloatArray, at: FloatArray) -> FloatArray:
    """(N, ...) four-point Lagrange interpolation of (T, ...) samples at instants (N,).

    times: (T,) ascending, T at least 4, in the unit of `at`. Raises ValueError if T is less.
    """
    count = len(times)
    if count < 4:
        raise ValueError("four samples are needed")
    first = np.clip(np.searchsorted(times, at, side="right") - 2, 0, count - 4)
    index = first[:, None] + np.arange(4)
    t = times[index]
    weights = np.ones_like(t)
    for i in range(4):
        for j in range(4):
            if i != j:
                weights[:, i] *= (at - t[:, j]) / (t[:, i] - t[:, j])
    return np.asarray(np.einsum("nk,nk...->n...", weights, samples[index]))
