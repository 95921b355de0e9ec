"""Offsets (C, 7) of controls from the take: of each a turn vector, a shift, and the log of a size,
as its basis has them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...solver.arrays import FloatArray, IntArray
from ...solver.numerics.rotations import rotation_matrix, rotation_vector
from ..armature.channels import proper
from .responses import Dof, Freedom

SIZE = 6  # column of offsets
_COLUMN = {Freedom.TURN: 0, Freedom.SHIFT: 3, Freedom.SIZE: SIZE}  # of offsets, the first


def with_offsets(animated: FloatArray, offsets: FloatArray) -> FloatArray:
    """Bases (C, 4, 4) with offsets (C, 7)."""
    bases = animated.copy()
    sizes = np.exp(offsets[:, SIZE])[:, None, None]
    bases[:, :3, :3] = sizes * (animated[:, :3, :3] @ rotation_matrix(offsets[:, :3]))
    bases[:, :3, 3] += offsets[:, 3:6]
    return bases


def changed(offsets: FloatArray, changes: FloatArray) -> FloatArray:
    """Offsets (C, 7) with small changes, turns last."""
    moved = offsets + changes
    turns = rotation_matrix(offsets[:, :3]) @ rotation_matrix(changes[:, :3])
    moved[:, :3] = rotation_vector(turns)
    return moved


def difference(before: FloatArray, after: FloatArray) -> FloatArray:
    """The changes (C, 7) that make offsets of others."""
    changes = after - before
    turns = np.swapaxes(rotation_matrix(before[:, :3]), 1, 2) @ rotation_matrix(after[:, :3])
    changes[:, :3] = rotation_vector(turns)
    return changes


def offsets_of(animated: FloatArray, bases: FloatArray) -> FloatArray:
    """Offsets (C, 7) from the animated bases, of which bases (C, 4, 4) differ but by size."""
    offsets = np.zeros((len(bases), 7))
    before, after = proper(animated[:, :3, :3]), proper(bases[:, :3, :3])
    offsets[:, :3] = rotation_vector(np.swapaxes(before, 1, 2) @ after)
    offsets[:, 3:6] = bases[:, :3, 3] - animated[:, :3, 3]
    return offsets


def places_of(dofs: Sequence[Dof]) -> tuple[IntArray, IntArray]:
    """Of dofs in offsets (C, 7): rows and columns (D,)."""
    controls = [dof.control for dof in dofs]
    return np.array(controls), np.array([_COLUMN[dof.freedom] + dof.axis for dof in dofs])
