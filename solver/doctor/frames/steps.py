"""Steps from a frame to the next that are unlike those beside them."""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from ...numerics.rotations import rotation_vector
from ..local_poses import LocalPoses

AROUND = 8  # steps on each side that one is compared with
BESIDE = 2  # steps on each side that one reaches, by what they are compared with


def turned_steps(local: LocalPoses, bone: int) -> FloatArray:
    """(T - 1,) rad, by which a bone's turn to the next frame differs from the mean of those beside
    it, or from the one beside it; 0 where one of those is longer, which is unlike itself."""
    turns = local.rotations[:, bone]
    return _uneven(rotation_vector(np.swapaxes(turns[:-1], -1, -2) @ turns[1:]))


def moved_steps(local: LocalPoses, bone: int) -> FloatArray:
    """(T - 1,) m, likewise of a bone's head."""
    return _uneven(np.diff(local.heads[:, bone], axis=0))


def leaping_steps(steps: FloatArray) -> FloatArray:
    """(S,) m, by which steps (S, 3) differ from the mean of those beside them, also where one of
    those is longer: of who runs the way back from where a frame leapt to is short."""
    return np.asarray(np.linalg.norm(steps - np.mean(_beside(steps), axis=0), axis=1))


def _uneven(steps: FloatArray) -> FloatArray:
    """(S,) of vectors (S, 3)."""
    own, most = (np.linalg.norm(each, axis=-1) for each in (steps, np.stack(_beside(steps))))
    return np.where(own < most.max(axis=0), 0.0, leaping_steps(steps))


def _beside(steps: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(S, 3) before each of some steps and after it; at the ends both are the one there is."""
    before, after = (
        np.concatenate([steps[:1], steps[:-1]]),
        np.concatenate([steps[1:], steps[-1:]]),
    )
    before[0], after[-1] = after[0], before[-1]
    return before, after


def around(uneven: FloatArray, first: int, last: int) -> float:
    """The most that steps (S,) before the first and after the last one, or between them, are unlike
    those beside them, apart from what these two themselves make of it."""
    near = np.arange(max(first - AROUND, 0), min(last + AROUND + 1, len(uneven)))
    own = (np.abs(near - first) <= BESIDE) | (np.abs(near - last) <= BESIDE)
    return float(uneven[near[~own]].max(initial=0.0))
