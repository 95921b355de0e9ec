"""The way over the floor, apart from the body's own movement."""

from __future__ import annotations

import numpy as np

from ...solver.arrays import FloatArray
from ...solver.numerics.rotations import axis_rotation
from ..armature.channels import proper

_UPRIGHT = 0.5  # cosine of the tilt up to which the pelvis tells where the figure faces
_LEVEL = np.array([1.0, 1.0, 0.0])


def way(pelvis: FloatArray, rest: FloatArray, *, steady: bool) -> FloatArray:
    """(T, 4, 4) moves over the floor that bring the figure at rest under the pelvis, and turn it to
    where the pelvis faces.

    pelvis (T, 4, 4), rest (4, 4): in the world. Height, pitch and roll stay the body's own. While
    it somersaults its heading goes on evenly. steady: at the mean speed, without turns, as a cycle
    that repeats needs it; the figure sways about it.
    """
    heading = np.zeros(len(pelvis)) if steady else _heading(pelvis, rest)
    if steady:
        heading += _heading(pelvis[:1], rest)
    found = np.tile(np.eye(4), (len(pelvis), 1, 1))
    found[:, :3, :3] = axis_rotation(2, heading)
    places = pelvis[:, :3, 3]
    if steady:
        line = np.linspace(places[0], places[-1], len(places))
        places = line + (places - line).mean(axis=0)
    found[:, :3, 3] = (places - found[:, :3, :3] @ rest[:3, 3]) * _LEVEL
    return found


def without_turns(found: FloatArray, rest: FloatArray) -> FloatArray:
    """The same way (T, 4, 4) for a figure that does not turn as it goes."""
    place = (found @ rest)[:, :3, 3]
    straight = np.tile(np.eye(4), (len(found), 1, 1))
    straight[:, :3, 3] = (place - rest[:3, 3]) * _LEVEL
    return straight


def _heading(pelvis: FloatArray, rest: FloatArray) -> FloatArray:
    """(T,) rad about the vertical, from where the figure faces at rest."""
    turns = proper(pelvis[:, :3, :3]) @ proper(rest[:3, :3]).T
    upright = np.flatnonzero(turns[:, 2, 2] > _UPRIGHT)
    if not len(upright):
        return np.zeros(len(pelvis))
    angles = np.arctan2(turns[:, 1, 0] - turns[:, 0, 1], turns[:, 0, 0] + turns[:, 1, 1])
    seen = np.unwrap(angles[upright])
    return np.interp(np.arange(len(pelvis)), upright, seen)
