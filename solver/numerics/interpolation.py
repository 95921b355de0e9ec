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
    apart = t[:, :, None] - t[:, None, :]
    apart[:, range(4), range(4)] = 1.0
    off = (at[:, None] - t).T
    first, last = off[0] * off[1], off[2] * off[3]
    others = np.stack([off[1] * last, off[0] * last, first * off[3], first * off[2]], axis=1)
    weights = others / apart.prod(axis=2)
    return np.asarray(np.einsum("nk,nk...->n...", weights, samples[index]))
