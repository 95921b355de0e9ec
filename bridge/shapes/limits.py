"""Rims of joint limits' cones and arcs, in axes of their own. Angles in rad.

A cone opens along x, its first stretch is along y. An arc counts from x towards y.
"""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
from numpy.typing import ArrayLike

from ...solver.arrays import FloatArray


def directions(angles: ArrayLike) -> FloatArray:
    """(..., 3) unit vectors at angles (...) from x towards y."""
    turn = np.asarray(angles, dtype=float)
    return np.stack([np.cos(turn), np.sin(turn), np.zeros_like(turn)], axis=-1)


def cone_rim(
    half_angle: float, stretch: tuple[float, float], length: float, around: int
) -> FloatArray:
    """(around + 1, 3) where a limb of this length may lean at most; closed.

    stretch: how many times as wide along y and z.
    """
    across = directions(np.linspace(0.0, 2 * pi, around + 1))[:, :2]
    ahead = np.full((len(across), 1), cos(half_angle))
    along = np.hstack([ahead, sin(half_angle) * across * stretch])
    return np.asarray(along * length / np.linalg.norm(along, axis=1, keepdims=True))
