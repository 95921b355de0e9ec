"""Euler angles of whole clips to rotation matrices."""

from collections.abc import Sequence

import numpy as np

from ...solver.arrays import FloatArray
from ...solver.numerics.rotations import axis_rotation


def euler_matrices(axes: Sequence[int], angles: FloatArray) -> FloatArray:
    """(T, 3, 3): R(axes[0]) R(axes[1]) ..., by the columns of angles (T, len(axes)), rad."""
    out = np.broadcast_to(np.eye(3), (len(angles), 3, 3)).copy()
    for column, axis in enumerate(axes):
        out = out @ axis_rotation(axis, angles[:, column])
    return out
