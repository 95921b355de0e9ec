"""Bursts: spikes of several frames, in which a bone is elsewhere and comes back."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from ...arrays import BoolArray, FloatArray
from ...body.anatomy import Part
from ...data.recording import Recording
from ...numerics.rotations import angles_between
from ..figure import Figure
from ..local_poses import LocalPoses
from ..slack import slack
from .steps import around, leaping_steps, turned_steps

# The steps to the first frame and from the last one, beyond those beside them; honest ones are up
# to 28° and 1.7 cm at 30 Hz, and do not come back.
TURN, TOE_TURN = np.radians(20.0), np.radians(45.0)
PLACE = 0.05  # m, the root
LONGEST = 6  # frames
RETURNED = 0.5  # of either step: the frames before and after are nearer to each other
STANDS_OUT = 4.0  # times what the steps around are off


def bursts(recording: Recording, local: LocalPoses, figure: Figure) -> BoolArray:
    """(T, B) which bones' poses in their parents are of two to six frames that do not belong.
    local: the recording's."""
    unsound = np.zeros(recording.heads.shape[:2], bool)
    if len(recording.frames) <= 4:
        return unsound
    for bone, part in figure.parts:
        turns = local.rotations[:, bone]

        def turned_back(into: int, out: int, turns: FloatArray = turns) -> bool:
            ends = np.array([into, out, into]), np.array([into + 1, out + 1, out + 1])
            there, back, left = angles_between(turns[ends[0]], turns[ends[1]])
            return bool(left < RETURNED * min(there, back))

        limit = (TOE_TURN if part is Part.TOE else TURN) * slack(recording.rate, part)
        for first, last in _bursts(turned_steps(local, bone), limit, turned_back):
            unsound[first : last + 1, bone] = True
    root, far = figure.bones[0], PLACE * slack(recording.rate)
    steps = np.diff(local.heads[:, root], axis=0)

    def moved_back(into: int, out: int) -> bool:
        """As seen by who moves as fast as the frames beside. Steps beside a leap are uneven, too,
        but no leaps."""
        beside = np.concatenate([steps[:into][-1:], steps[out + 1 :][:1]])
        seen = steps[into : out + 1] - beside.sum(axis=0) / max(len(beside), 1)
        left = np.linalg.norm(seen.sum(axis=0))
        leapt = np.linalg.norm(seen[[0, -1]], axis=1).min()
        return bool(leapt > far and left < RETURNED * leapt)

    for first, last in _bursts(leaping_steps(steps), far, moved_back):
        unsound[first : last + 1, root] = True
    return unsound


def _bursts(
    uneven: FloatArray, limit: float, returned: Callable[[int, int], bool]
) -> Iterator[tuple[int, int]]:
    """First and last frame of each. uneven: (T - 1,). returned: whether what leaves by one step is
    back after another."""
    edges = np.flatnonzero(uneven > limit).tolist()
    for into in edges:
        for out in (e for e in edges if 2 <= e - into <= LONGEST):
            stands_out = STANDS_OUT * around(uneven, into, out) < min(uneven[into], uneven[out])
            if stands_out and returned(into, out):
                yield into + 1, out
