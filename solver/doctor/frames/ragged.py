"""Ragged ends: the first frames, or the last, in which a bone jumps about from each to the next, as
where capture has not found the performer yet, or loses him."""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from ...numerics.rotations import rotation_vector
from ..local_poses import LocalPoses
from .steps import AROUND

LONGEST = 0.5  # s
RAGGED = np.radians(20.0)  # beyond the steps on the sound side; honest ones come alone
FEWEST = 3  # steps; of fewer a spike or a jump tells
STANDS_OUT = 4.0  # times what the steps on the sound side are off


def ragged_ends(local: LocalPoses, bone: int, wider: float, rate: float) -> tuple[int, int]:
    """How many frames at the beginning and at the end. wider: what limits are multiplied by at so
    many frames a second."""
    turns = local.rotations[:, bone]
    steps = rotation_vector(np.swapaxes(turns[:-1], -1, -2) @ turns[1:])
    longest = min(round(LONGEST * rate), len(steps) // 2)
    limit = RAGGED * wider
    return _ragged(steps, longest, limit), _ragged(steps[::-1], longest, limit)


def _ragged(steps: FloatArray, longest: int, limit: float) -> int:
    """How many of the first steps (S, 3), rad, up to one that is far off and after which no other
    is; 0 where too few are."""
    off = np.linalg.norm(steps[:-2] - 0.5 * (steps[1:-1] + steps[2:]), axis=1)
    far = np.flatnonzero(off[:longest] > limit)
    if len(far) < FEWEST:
        return 0
    last = int(far[-1])
    sound = off[last + 1 : last + 1 + AROUND]
    return last + 1 if len(sound) and off[last] > STANDS_OUT * sound.max() else 0
