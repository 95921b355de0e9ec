"""A bind pose before the motion, or after it: exporters put the T pose, or rest pose, on the first
frames, and some on the last."""

from dataclasses import replace

import numpy as np

from ..arrays import FloatArray
from ..data.recording import Recording
from ..numerics.rotations import angles_between

AT_REST = np.radians(2.0)  # a joint that is nearer to its rest than this is at rest
SHARE = 0.95  # of the joints that are at rest in a bind pose
JUMP = np.radians(20.0)  # from a frame to the next; at 24 a second no joint leaves its rest so fast
# Some put a T pose with legs apart before a motion whose rest has them beside each other: most are
# at rest and none is far from it, and then a part of all jump. Recordings' own frames have 0.3 of
# them at rest, and none jumps at the beginning.
MOST, NEAR, PART = 0.8, np.radians(30.0), 0.2


def bind_frames(recording: Recording) -> int:
    """How many frames at the beginning hold the rest pose, from which the motion then jumps.

    0 where there are none, and where a performer who stands like this moves on smoothly.
    """
    pairs = [(i, bone.parent) for i, bone in enumerate(recording.bones) if bone.parent >= 0]
    if not pairs:
        return 0
    bones, parents = map(list, zip(*pairs, strict=True))
    rest = np.stack([bone.rotation for bone in recording.bones])
    local = _between(recording.rotations[:, parents], recording.rotations[:, bones])
    away = angles_between(_between(rest[parents], rest[bones])[None], local)
    resting = (away < AT_REST).mean(axis=1)
    leaning = (resting >= MOST) & (away.max(axis=1) < NEAR)
    for held, least in ((resting >= SHARE, 0.0), (leaning, PART)):
        count = int(np.argmin(held)) if not held.all() else 0
        if count and (angles_between(local[count - 1], local[count]) > JUMP).mean() > least:
            return count
    return 0


def last_bind_frames(recording: Recording) -> int:
    """How many frames at the end hold the rest pose, to which the motion jumps: seen backwards they
    are the first."""
    return bind_frames(replace(recording, rotations=recording.rotations[::-1]))


def _between(first: FloatArray, second: FloatArray) -> FloatArray:
    """Rotations (..., 3, 3) of the second in the first's frame."""
    return np.asarray(np.swapaxes(first, -1, -2) @ second)
