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
from .steps import around, moved_steps, turned_steps

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

        def turned(one: int, other: int, turns: FloatArray = turns) -> float:
            return float(angles_between(turns[one], turns[other]))

        limit = (TOE_TURN if part is Part.TOE else TURN) * slack(recording.rate, part)
        for first, last in _bursts(turned_steps(local, bone), limit, turned):
            unsound[first : last + 1, bone] = True
    root = figure.bones[0]

    def moved(one: int, other: int) -> float:
        return float(np.linalg.norm(local.heads[one, root] - local.heads[other, root]))

    for first, last in _bursts(moved_steps(local, root), PLACE * slack(recording.rate), moved):
        unsound[first : last + 1, root] = True
    return unsound


def _bursts(
    uneven: FloatArray, limit: float, apart: Callable[[int, int], float]
) -> Iterator[tuple[int, int]]:
    """First and last frame of each. uneven: (T - 1,). apart: of two frames' poses."""
    edges = np.flatnonzero(uneven > limit).tolist()
    for into in edges:
        for out in (e for e in edges if 2 <= e - into <= LONGEST):
            least = min(apart(into, into + 1), apart(out, out + 1))
            stands_out = STANDS_OUT * around(uneven, into, out) < min(uneven[into], uneven[out])
            if stands_out and apart(into, out + 1) < RETURNED * least:
                yield into + 1, out
