"""Poses that are held amid a movement, and frames that are missing."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

import numpy as np

from ...arrays import BoolArray, FloatArray
from ...data.problem import Mend
from ...data.recording import Recording
from ..finding import Finding, FindingKind
from ..local_poses import runs, spans
from ..repairs import MissingFrames, Repairs
from ..slack import SPARSE

HELD = 1e-5  # m and entries of a matrix; a pose that changes by less is held
MOVING = 1e-3  # m, of the farthest joint from a frame to the next, beside a pose that is held
LONGEST_HELD = 0.25  # s; a longer one is a pause
# Missing frames of steps side by side.
COUNTS = (
    *((count,) for count in range(1, 11)),
    *product((1, 2, 3), repeat=2),
    *product((1, 2), repeat=3),
)
BESIDE = 2  # steps on each side of these
NEARER = 2.2  # times, to a cubic, if the frames are missing; where two are, two apart, 2.7 and more
STANDS_OUT = 2.5  # times the median of how far those around are from one
ALIKE = 0.4  # of a step, by which it may differ from its neighbours' way


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
    """Steps of the whole body, one to three side by side, in which frames are missing. None is told
    of sparse frames."""
    if recording.rate < SPARSE:
        return None
    places = recording.heads.reshape(len(recording.frames), -1)
    found = [each for lacking in COUNTS for each in _lacking(places, lacking)]
    counts = np.zeros(len(recording.frames), int)  # before each frame
    for _, at, lacking in sorted(found, reverse=True):  # the clearest first
        if not counts[at - 1 : at + len(lacking) + 1].any():  # nor are the steps beside too long
            counts[at : at + len(lacking)] = lacking
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


def _lacking(
    places: FloatArray, counts: tuple[int, ...]
) -> Iterator[tuple[float, int, tuple[int, ...]]]:
    """Where joints at places (T, D) are nearer to a cubic if steps side by side lack so many
    frames: how many times nearer, the first frame after one, and the counts."""
    size = len(counts) + 1 + 2 * BESIDE
    if len(places) < size:
        return
    beside = np.ones(BESIDE)
    true = np.concatenate([[0.0], beside, np.array(counts) + 1.0, beside]).cumsum()
    off, left = (_from_cubic(places, instants) for instants in (np.arange(float(size)), true))
    ratio = off / np.maximum(left, 1e-9)
    for at in np.flatnonzero((ratio > NEARER) & _is_alike(places, len(counts), len(off))).tolist():
        around = off[max(at - 2 * size, 0) : at + 2 * size + 1]  # most have none of these steps
        if off[at] > STANDS_OUT * np.median(around):
            yield float(ratio[at]), at + BESIDE + 1, counts


def _from_cubic(places: FloatArray, instants: FloatArray) -> FloatArray:
    """(N,) m, how far each run of places (T, D), at instants (S,), is from the nearest cubic."""
    basis, _ = np.linalg.qr(np.vander(instants - instants.mean(), 4), mode="complete")
    square = np.zeros(len(places) - len(instants) + 1)
    for weights in basis[:, 4:].T:  # one after the other: all windows at once fill the memory
        beyond = sum(w * places[k : k + len(square)] for k, w in enumerate(weights))
        square += np.einsum("td,td->t", beyond, beyond)
    return np.sqrt(square)


def _is_alike(places: FloatArray, several: int, count: int) -> BoolArray:
    """(count,) whether all of several steps, side by side after BESIDE others, go the way of those
    before and after them, as no jump does, and these move."""
    moves = np.diff(places, axis=0)
    before, after = (moves[k : k + count] for k in (BESIDE - 1, BESIDE + several))
    alike = np.ones(count, bool)
    for k in range(several):
        own, share = moves[BESIDE + k : BESIDE + k + count], (k + 1) / (several + 1)
        usual = before + share * (after - before)
        square = np.maximum(np.einsum("ti,ti->t", usual, usual), 1e-12)
        times = np.einsum("ti,ti->t", own, usual) / square
        rest = np.linalg.norm(own - times[:, None] * usual, axis=1)
        alike &= rest < ALIKE * np.linalg.norm(own, axis=1)
        alike &= np.abs(usual).max(axis=1) > MOVING
    return alike


def _steps(recording: Recording) -> FloatArray:
    """(T - 1,) m, by which the joint that moves most does so from a frame to the next."""
    return np.asarray(np.linalg.norm(np.diff(recording.heads, axis=0), axis=2).max(axis=1))
