"""Poses that are held amid a movement: by frames over others, or by frames that are too many.

Where the movement goes on as if time had passed, the held frames stand for others, which are filled
in. Where it goes on from where it stopped, they were put in, and are taken out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import BoolArray, FloatArray
from ...data.problem import Mend
from ...data.recording import Recording
from ...numerics.runs import runs
from ..finding import Finding, FindingKind
from ..local_poses import spans
from ..repairs import MissingFrames, Repairs
from .missing import BESIDE, off_cubic

HELD = 1e-5  # m and entries of a matrix; a pose that changes by less is held
MOVING = 1e-3  # m, of the farthest joint from a frame to the next, beside a pose that is held
LONGEST_HELD = 0.25  # s; a longer one is a pause, but where the body stops and starts in a frame:
LONGEST_FROZEN, SUDDEN = 1.0, 0.3  # s; m/s, of the farthest joint before and after
FASTER = 2.0  # than beside it, on its way while it is held; what goes further jumps
FEWEST_REPEATED = 3  # frames; of fewer the steps beside do not tell


@dataclass(frozen=True)
class HeldPose:
    """A pose that is held. at: index of its own frame; count: of those after it that repeat it.
    repeated: whether the movement then goes on from where it stopped."""

    at: int
    count: int
    repeated: bool


def holds(recording: Recording) -> list[HeldPose]:
    """The poses that are held while the body moves before and after."""
    moves, steps = _moves(recording), steps_between(recording)
    still, found = still_steps(recording, steps), list[HeldPose]()
    for first, last in runs(still):
        if first == 0 or last == len(steps) - 1:
            continue
        count, least = last - first + 1, min(steps[first - 1], steps[last + 1])
        if count > LONGEST_HELD * recording.rate:
            beside = max(steps[first - 1], steps[last + 2 : last + 3].max(initial=0.0))
            sudden = count <= LONGEST_FROZEN * recording.rate and least * recording.rate > SUDDEN
            if not sudden or steps[last + 1] > FASTER * (count + 1) * beside:
                continue
        if least > MOVING:
            found.append(HeldPose(first, count, _goes_on(moves, still, first, last)))
    return found


def steps_between(recording: Recording) -> FloatArray:
    """(T - 1,) m, of the farthest joint from a frame to the next."""
    moves = _moves(recording)
    return np.asarray(np.linalg.norm(moves.reshape(len(moves), -1, 3), axis=2).max(axis=1))


def still_steps(recording: Recording, steps: FloatArray) -> BoolArray:
    """(T - 1,) whether nothing moves or turns from a frame to the next. steps: as above."""
    turned = np.abs(np.diff(recording.rotations, axis=0)).max(axis=(1, 2, 3))
    return np.asarray((steps < HELD) & (turned < HELD))


def held_frames(recording: Recording) -> BoolArray:
    """(T,) frames in which a pose is held over others, that are lost."""
    return _frames(recording, [each for each in holds(recording) if not each.repeated])


def find_held(recording: Recording) -> Finding | None:
    """Poses that are held over frames that are lost."""
    held = held_frames(recording)
    if not held.any():
        return None
    remedy = Repairs(mend=(Mend.HELD_FRAMES,))
    count = float(held.sum())
    return Finding(FindingKind.HELD_FRAMES, count, "frames", spans(recording, held), "", remedy)


def find_repeated(recording: Recording) -> Finding | None:
    """Poses that are held by frames that are too many."""
    found = [each for each in holds(recording) if each.repeated]
    if not found:
        return None
    extra = tuple(MissingFrames(round(recording.frames[h.at]), -h.count) for h in found)
    return Finding(
        FindingKind.REPEATED_FRAMES,
        float(sum(each.count for each in found)),
        "frames",
        spans(recording, _frames(recording, found)),
        remedy=Repairs(missing=extra),
    )


def _moves(recording: Recording) -> FloatArray:
    """(T - 1, D) m, of all joints from a frame to the next."""
    return np.asarray(np.diff(recording.heads.reshape(len(recording.frames), -1), axis=0))


def _frames(recording: Recording, found: list[HeldPose]) -> BoolArray:
    """(T,) those that repeat a pose."""
    out = np.zeros(len(recording.frames), bool)
    for hold in found:
        out[hold.at + 1 : hold.at + hold.count + 1] = True
    return out


def _goes_on(moves: FloatArray, still: BoolArray, first: int, last: int) -> bool:
    """Whether joints are nearer to a cubic if no time passed in the still steps, from the first to
    the last. moves: (T - 1, D) m, from a frame to the next."""
    count = last - first + 1
    beside = np.r_[first - BESIDE : first, last + 1 : last + 2 + BESIDE]
    inside = beside[0] >= 0 and beside[-1] < len(moves)
    if count < FEWEST_REPEATED or not inside or still[beside].any():
        return False
    own = moves[beside]
    off = []
    for passed in (1.0, count + 1.0):
        took = np.ones(len(beside))
        took[BESIDE] = passed
        instants = np.concatenate([[0.0], took]).cumsum()
        off.append(float(off_cubic((own @ own.T)[:, :, None], instants)[0]))
    return off[0] < off[1]
