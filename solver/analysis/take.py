"""The take that a range of frames is cut from: frames beyond it tell of its first and last ones."""

from dataclasses import replace

import numpy as np

from ..data.faults import ClipTooShort, OutsideKeys
from ..data.recording import BEYOND, MIN_CLIP_DURATION, Recording

HELD = 1e-6  # m; a pose that moves by less from frame to frame is held, not recorded
JUMP_SPEED = 15.0  # m/s; joints that are this fast at once have jumped, from a T-pose mostly
JUMP_RATIO = 2.0  # unless they are half as fast within the range: throws, sprints


def require_inside(frames: tuple[float, float], name: str, recorded: tuple[float, float]) -> None:
    """Whether frames reach into those that a recording has. name: what is recorded, to the artist.

    Raises OutsideKeys, and ClipTooShort of a single pose.
    """
    if recorded[0] == recorded[1]:
        raise ClipTooShort(0.0, MIN_CLIP_DURATION, recorded, chosen=False)
    if frames[0] >= recorded[1] or frames[1] <= recorded[0]:
        raise OutsideKeys(name, *recorded)


def take_of(recording: Recording, within: Recording) -> Recording:
    """The range `within` of a recording and up to BEYOND s on both sides, times 0 where it begins.

    It goes as far as the movement goes on: a pose that is held or jumps is no part of it.
    """
    first = int(np.searchsorted(recording.frames, within.frames[0] - 1e-6))
    last = first + len(within.frames) - 1
    steps = np.linalg.norm(np.diff(recording.heads, axis=0), axis=2).max(axis=1)
    speeds = steps / np.diff(recording.times)
    fastest = max(JUMP_SPEED, JUMP_RATIO * float(speeds[first:last].max()))
    ends = np.flatnonzero((steps < HELD) | (speeds > fastest))
    start = int(max(ends[ends < first], default=-1)) + 1
    end = int(min(ends[ends >= last], default=len(steps)))
    reach = round(BEYOND * within.rate)
    take = recording.part(slice(max(start, first - reach), min(end, last + reach) + 1))
    return replace(take, times=take.times - recording.times[first])
