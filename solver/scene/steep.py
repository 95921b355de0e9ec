"""What is too steep to stand on: there feet and hands push off, as from a wall."""

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..data.constants import DEFAULT_FRICTION


def is_steep(normals: FloatArray) -> BoolArray:
    """(N,) whether faces with normals (N, 3) bear no weight by the friction that shoes have: the
    vertical is not in its cone. Undersides are among them."""
    return np.asarray(_across(normals) > DEFAULT_FRICTION * normals[:, 2])


def is_side(normals: FloatArray) -> BoolArray:
    """(N,) whether faces with normals (N, 3) are steep but no undersides."""
    return np.asarray(_across(normals) > DEFAULT_FRICTION * np.abs(normals[:, 2]))


def _across(normals: FloatArray) -> FloatArray:
    return np.asarray(np.hypot(normals[:, 0], normals[:, 1]))
