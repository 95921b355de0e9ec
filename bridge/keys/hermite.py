"""Piecewise cubic Hermite curves, and their least-squares fit to samples.

Blender's F-curves are such where handles reach a third of the way to the next key: time then runs
evenly along the Bézier.
"""

from __future__ import annotations

import numpy as np

from ...solver.arrays import FloatArray, IntArray
from .bezier import BezierKeys

# Weight of the squared second derivative, against samples that weigh 1 each: it decides what the
# samples do not, a slope between keys on neighbouring frames, and moves nothing else.
BENDING = 1e-6


def fitted(samples: FloatArray, frames: FloatArray, at: FloatArray) -> BezierKeys:
    """Least-squares fit to samples (T, n) at frames (T,), with keys at frames (K,), K >= 2."""
    normal, right = _normal_equations(samples, frames, at)
    solved = np.linalg.solve(normal, right)
    return BezierKeys.even(at, solved[0::2], solved[1::2])


def _normal_equations(
    samples: FloatArray, frames: FloatArray, at: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Matrix (2 K, 2 K) and right-hand side (2 K, n) of the fit of value, slope, value, ..."""
    span, weights = _weights(frames, at)
    count = len(at)
    normal = np.zeros((2 * count, 2 * count))
    right = np.zeros((2 * count, samples.shape[1]))
    unknown = 2 * span[:, None] + np.arange(4)
    np.add.at(
        normal, (unknown[:, :, None], unknown[:, None, :]), weights[:, :, None] * weights[:, None]
    )
    np.add.at(right, unknown, weights[:, :, None] * samples[:, None])
    unknown = 2 * np.arange(count - 1)[:, None] + np.arange(4)
    bent = BENDING * _bending(np.diff(at))
    np.add.at(normal, (unknown[:, :, None], unknown[:, None, :]), bent)
    return normal, right


def _weights(frames: FloatArray, at: FloatArray) -> tuple[IntArray, FloatArray]:
    """Spans (T,) of frames (T,) between keys (K,), and the weights (T, 4) of the value and slope
    before and of those after."""
    span = np.clip(np.searchsorted(at, frames, side="right") - 1, 0, len(at) - 2)
    length = at[span + 1] - at[span]
    u = (frames - at[span]) / length
    rest = 1.0 - u
    weights = np.stack(
        [
            rest**2 * (1.0 + 2.0 * u),
            length * u * rest**2,
            u**2 * (3.0 - 2.0 * u),
            -length * u**2 * rest,
        ],
        axis=1,
    )
    return span, weights


def _bending(length: FloatArray) -> FloatArray:
    """Matrices (S, 4, 4) of the integral of the squared second derivative over spans of length
    (S,): an Euler-Bernoulli beam's stiffness."""
    h, one = length, np.ones_like(length)
    rows = [
        [12.0 * one, 6.0 * h, -12.0 * one, 6.0 * h],
        [6.0 * h, 4.0 * h**2, -6.0 * h, 2.0 * h**2],
        [-12.0 * one, -6.0 * h, 12.0 * one, -6.0 * h],
        [6.0 * h, 2.0 * h**2, -6.0 * h, 4.0 * h**2],
    ]
    return np.asarray(np.moveaxis(np.array(rows), 2, 0) / (h**3)[:, None, None])
