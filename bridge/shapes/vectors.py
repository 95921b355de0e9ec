"""Arrays of three-vectors: lengths, cross products, right angles."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ...solver.arrays import FloatArray

SHORTEST = 1e-9


def unit(vectors: FloatArray) -> FloatArray:
    """Vectors (..., 3) scaled to length 1; those without a length stay."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.asarray(vectors / np.maximum(length, SHORTEST))


def cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """a x b along the last axis; a few arrays of three are quicker so than by numpy's own."""
    x, y, z = a[..., 0], a[..., 1], a[..., 2]
    u, v, w = b[..., 0], b[..., 1], b[..., 2]
    return np.stack([y * w - z * v, z * u - x * w, x * v - y * u], axis=-1)


def across(ahead: ArrayLike) -> FloatArray:
    """A unit vector at right angles to each unit vector (..., 3)."""
    a = np.asarray(ahead, dtype=float)
    fixed = np.where(np.abs(a[..., 2:]) < 0.9, (0.0, 0.0, 1.0), (1.0, 0.0, 0.0))
    return unit(cross(a, fixed))
