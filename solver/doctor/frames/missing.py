"""Poses that are held amid a movement, and frames that are missing."""

from __future__ import annotations

import numpy as np

from ...arrays import BoolArray, FloatArray, IntArray
from ...data.problem import Mend
from ...data.recording import Recording
from ..finding import Finding, FindingKind
from ..local_poses import runs, spans
from ..repairs import MissingFrames, Repairs
from ..slack import SPARSE

HELD = 1e-5  # m and entries of a matrix; a pose that changes by less is held
MOVING = 1e-3  # m, of the farthest joint from a frame to the next, beside a pose that is held
LONGEST_HELD = 0.25  # s; a longer one is a pause
DROPPED = (0.8, 10.5)  # further than the frames beside: by one to ten missing frames
SIDE_BY_SIDE = 3  # steps with missing frames, one frame from each to the next
ALIKE = 0.15  # of a step, by which it may differ from its neighbours' way


def held_frames(recording: Recording) -> BoolArray:
    """(T,) frames in which a body that moves before and after has the pose of the frame before."""
    steps = _steps(recording)
    turned = np.abs(np.diff(recording.rotations, axis=0)).max(axis=(1, 2, 3))
    still = (steps < HELD) & (turned < HELD)
    out = np.zeros(len(recording.frames), bool)
    for first, last in runs(still):
        inside = first > 0 and last < len(steps) - 1
        short = (last - first + 1) / recording.rate <= LONGEST_HELD
        if inside and short and min(steps[first - 1], steps[last + 1]) > MOVING:
            out[first + 1 : last + 2] = True
    return out


def find_held(recording: Recording) -> Finding | None:
    """Poses that are held, or doubled, amid a movement."""
    held = held_frames(recording)
    if not held.any():
        return None
    remedy = Repairs(mend=(Mend.HELD_FRAMES,))
    count = float(held.sum())
    return Finding(FindingKind.HELD_FRAMES, count, "frames", spans(recording, held), "", remedy)


def find_dropped(recording: Recording) -> Finding | None:
    """Steps of the whole body, one to three side by side, each as long as two to eleven of those
    before and after them: frames are missing. None is told of sparse frames."""
    if recording.rate < SPARSE:
        return None
    moves = np.diff(recording.heads, axis=0).reshape(len(recording.frames) - 1, -1)
    counts = np.zeros(len(recording.frames), int)  # before each frame
    # The most first: a step beside one that is too long is not what either is measured by.
    for several in range(SIDE_BY_SIDE, 0, -1):
        lacking = _lacking(moves, several)
        for start in np.flatnonzero(lacking.all(axis=1)).tolist():
            if not counts[start + 1 : start + several + 3].any():  # nor of the steps beside them
                counts[start + 2 : start + several + 2] = lacking[start]
    after = np.flatnonzero(counts)
    if len(after) == 0:
        return None
    missing = tuple(MissingFrames(round(recording.frames[t - 1]), int(counts[t])) for t in after)
    return Finding(
        FindingKind.DROPPED_FRAMES,
        float(counts.sum()),
        "frames",
        spans(recording, counts > 0),
        remedy=Repairs(missing=missing),
    )


def _lacking(moves: FloatArray, several: int) -> IntArray:
    """(S - several - 1, several) how many frames each of several steps side by side lacks, from the
    second step on, by the steps (S, 3 B) before and after them; 0 where it lacks none."""
    found = np.zeros((max(len(moves) - several - 1, 0), several), int)
    if len(found) == 0:
        return found
    before, after = moves[: len(found)], moves[several + 1 :]
    for k in range(several):
        own, share = moves[k + 1 : k + 1 + len(found)], (k + 1) / (several + 1)
        usual = before + share * (after - before)
        square = np.maximum(np.einsum("ti,ti->t", usual, usual), 1e-12)
        times = np.einsum("ti,ti->t", own, usual) / square
        rest = np.linalg.norm(own - times[:, None] * usual, axis=1)
        alike = rest < ALIKE * np.linalg.norm(own, axis=1)
        whole = (times - 1.0 > DROPPED[0]) & (times - 1.0 < DROPPED[1])
        fast = np.abs(usual).max(axis=1) > MOVING
        found[:, k] = np.where(whole & alike & fast, np.round(times - 1.0), 0)
    return found


def _steps(recording: Recording) -> FloatArray:
    """(T - 1,) m, by which the joint that moves most does so from a frame to the next."""
    return np.asarray(np.linalg.norm(np.diff(recording.heads, axis=0), axis=2).max(axis=1))
