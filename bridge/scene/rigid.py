"""Object matrices over time as a rigid movement, and what of them goes into the vertices."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...solver.arrays import FloatArray
from ..armature.channels import proper

STILL = 1e-6  # m, and of rotation matrices' entries
UNEVEN = 1e-4  # of an object's size; more is another shape


@dataclass(frozen=True)
class RigidMovement:
    """An object's movement.

    baked: (3, 3), scale, mirroring and shear at the first instant, for the vertices. positions:
    (T, 3), rotations: (T, 3, 3), object to world; T is 1 where it stands still. stretches: whether
    its scale or shear changes, which no rigid movement does.
    """

    baked: FloatArray
    positions: FloatArray
    rotations: FloatArray
    stretches: bool

    @property
    def moves(self) -> bool:
        return len(self.positions) > 1


def rigid_movement(matrices: FloatArray, metres: float) -> RigidMovement:
    """Of object matrices (T, 4, 4), Blender units; positions in m.

    The first matrix is kept exactly: what is no rotation of it is baked (polar decomposition).
    """
    linear, positions = matrices[:, :3, :3], metres * matrices[:, :3, 3]
    baked = proper(linear[:1])[0].T @ linear[0]
    rotations = proper(linear @ np.linalg.pinv(baked))
    size = max(float(np.abs(baked).max()), 1e-12)
    stretches = bool(np.abs(rotations @ baked - linear).max() > UNEVEN * size)
    still = np.abs(positions - positions[0]).max() <= STILL
    if still and np.abs(rotations - rotations[0]).max() <= STILL:
        positions, rotations = positions[:1], rotations[:1]
    return RigidMovement(baked, positions, rotations, stretches)
