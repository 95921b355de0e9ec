"""Closest points of two segments, many pairs at once."""

import numpy as np

from ..arrays import FloatArray

PARALLEL = 1e-6  # squared sine, below which any share of the first segment serves to begin with
LEAST = 1e-12  # m², squared length of a segment that is a point


def closest_shares(
    p: FloatArray, u: FloatArray, q: FloatArray, v: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Shares s, t (N,) in [0, 1] of the closest points p + s u and q + t v, all (N, 3) m.

    Ericson, Real-Time Collision Detection (2005), 5.1.9.
    """
    apart = p - q
    a, b, e = (np.einsum("ni,ni->n", *pair) for pair in ((u, u), (u, v), (v, v)))
    c, f = np.einsum("ni,ni->n", u, apart), np.einsum("ni,ni->n", v, apart)
    a, e = np.maximum(a, LEAST), np.maximum(e, LEAST)
    sine = a * e - b * b
    crossing = sine > PARALLEL * a * e
    s = np.where(crossing, np.clip((b * f - c * e) / np.where(crossing, sine, 1.0), 0, 1), 0.5)
    t = np.clip((b * s + f) / e, 0.0, 1.0)
    return np.clip((b * t - c) / a, 0.0, 1.0), t
