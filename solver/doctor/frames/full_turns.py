"""Full turns: a bone turns once around within a few frames and ends where it would have been.

An Euler angle that leaps from 180° to -180° leaves the pose as it is. Where a program interpolates
the angle itself, as exporters do that resample, the bone spins through the frames in between.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from ...arrays import BoolArray, FloatArray
from ...data.problem import Mend
from ...data.recording import Recording
from ...numerics.rotations import angles_between, rotation_matrix, rotation_vector
from ..figure import Figure
from ..finding import Finding, FindingKind
from ..local_poses import LocalPoses, spans
from ..repairs import Repairs
from ..slack import SPARSE

STEPS = range(3, 8)  # from frame to frame; of two, half a turn each, a flip tells
LONGEST = 0.24  # s; whole bodies take 0.3 and more to turn once, and begin and end softly
AROUND = np.radians(60.0)  # by which the steps, less those beside them, may miss a full turn
COAXIAL = 0.9  # of the steps' lengths, that they make together: all turn about one axis
EVEN = 0.4  # of the longest step, all but the first and last; of a flip there and back one is 0
STANDS_OUT = 2.0  # times the steps beside them: no body begins and ends to spin in a frame
LEAST = np.radians(8.0)  # of the first and the last step
RETURNED = np.radians(90.0)  # to where it would have been; a limb bends its way meanwhile


def full_turns(recording: Recording, local: LocalPoses, figure: Figure) -> BoolArray:
    """(T, B) which bones' poses are of frames within a full turn; of sparse frames none is told.
    local: the recording's."""
    unsound = np.zeros(recording.heads.shape[:2], bool)
    if recording.rate < SPARSE:
        return unsound
    longest = int(LONGEST * recording.rate)
    for bone in figure.bones:
        for first, last in _turns(local.rotations[:, bone], longest):
            unsound[first : last + 1, bone] = True
    return unsound


def find_full_turns(recording: Recording, figure: Figure) -> Finding | None:
    """Bones that turn once around within a few frames."""
    unsound = full_turns(recording, LocalPoses.of(recording), figure)
    if not unsound.any():
        return None
    worst = recording.bones[int(np.argmax(unsound.sum(axis=0)))].name
    remedy = Repairs(mend=(Mend.FULL_TURNS,))
    where = spans(recording, unsound.any(axis=1))
    return Finding(FindingKind.FULL_TURN, 360.0, "°", where, worst, remedy)


def without_full_turns(recording: Recording, figure: Figure) -> Recording:
    """With the bones turned on from the frame before to the one after; places stay."""
    local = LocalPoses.of(recording)
    unsound = full_turns(recording, local, figure)
    turned = LocalPoses(local.filled(unsound).rotations, local.heads)
    return turned.posed(recording)


def _turns(turns: FloatArray, longest: int) -> Iterator[tuple[int, int]]:
    """First and last frame inside each full turn of rotations (T, 3, 3). longest: steps of one."""
    steps = rotation_vector(np.swapaxes(turns[:-1], -1, -2) @ turns[1:])
    found = [each for n in STEPS if n <= longest for each in _windows(turns, steps, n)]
    taken = np.zeros(len(turns), bool)
    for _, at, n in sorted(found):  # those first that end nearest to where they would have been
        if not taken[at : at + n + 1].any():
            taken[at : at + n + 1] = True
            yield at + 1, at + n - 1


def _windows(turns: FloatArray, steps: FloatArray, n: int) -> Iterator[tuple[float, int, int]]:
    """All n of the steps (T - 1, 3), rad, that make a full turn: how far off it ends, rad, its
    first step, and n."""
    inside = len(steps) - n - 1  # whose first step has one before it, and the last one after it
    if inside < 1:
        return
    lengths = np.linalg.norm(steps, axis=1)
    own = sliding_window_view(lengths[1:-1], n)
    sums = sliding_window_view(steps[1:-1], n, axis=0).sum(axis=2)
    beside = np.maximum(lengths[:inside], lengths[n + 1 :])
    usual = 0.5 * n * (steps[:inside] + steps[n + 1 :])
    around = np.abs(np.linalg.norm(sums - usual, axis=1) - 2.0 * np.pi) < AROUND
    coaxial = np.linalg.norm(sums, axis=1) > COAXIAL * own.sum(axis=1)
    even = own[:, 1:-1].min(axis=1) > EVEN * own.max(axis=1)
    edges = np.minimum(own[:, 0], own[:, -1])
    sudden = edges > np.maximum(STANDS_OUT * beside, LEAST)
    for t in np.flatnonzero(around & coaxial & even & sudden).tolist():
        expected = turns[t + 1] @ rotation_matrix(usual[t])
        off = float(angles_between(expected, turns[t + 1 + n]))
        if off < RETURNED:
            yield off, t + 1, n
