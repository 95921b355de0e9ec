"""What is too steep to stand on: there feet and hands push off, as from a wall."""

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..data.constants import DEFAULT_FRICTION


def is_steep(normals: FloatArray) -> BoolArray:
    """(N,) whether faces with normals (N, 3) bear no weight by the friction that shoes have: the
    vertical is not in its cone. Undersides are among them."""
    across = np.hypot(normals[:, 0], normals[:, 1])
    return np.asarray(across > DEFAULT_FRICTION * normals[:, 2])
