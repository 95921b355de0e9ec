"""A bind pose before the motion, or after it: exporters put the T pose, or rest pose, on the first
frames, and some on the last."""

from dataclasses import replace

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..data.recording import Recording
from ..numerics.rotations import angles_between

AT_REST = np.radians(2.0)  # a joint that is nearer to its rest than this is at rest
SHARE = 0.95  # of the joints that are at rest in a bind pose
JUMP = np.radians(20.0)  # from a frame to the next; at 24 a second no joint leaves its rest so fast
# Some put a T pose with legs apart before a motion whose rest has them beside each other: most are
# at rest and none is far from it, and then a part of all jump. Recordings' own frames have 0.3 of
# them at rest, and none jumps at the beginning.
MOST, NEAR, PART = 0.8, np.radians(30.0), 0.2
# Others put a T pose before a motion whose rest hangs the arms, with a wrist or the head off by
# some degrees: joints beyond TURNED are alike in pairs, two thirds of all are at rest. Of those not
# turned 0.63 and more leave such a pose at once; where arms alone are keyed in steps none does.
TURNED, ALIKE, LEAST, LEAVE = np.radians(10.0), np.radians(5.0), 0.65, 0.5


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
        count = _beginning(held)
        if count and _jumps(local, count).mean() > least:
            return count
    return _spread_frames(away, local)


def last_bind_frames(recording: Recording) -> int:
    """How many frames at the end hold the rest pose, to which the motion jumps: seen backwards they
    are the first."""
    return bind_frames(replace(recording, rotations=recording.rotations[::-1]))


def _spread_frames(away: FloatArray, local: FloatArray) -> int:
    """Likewise of a T pose where the rest hangs the arms: a few joints are far from their rest,
    each as far as another one, and jump together as most others leave theirs. away: (T, J) rad.
    local: (T, J, 3, 3)."""
    turned = away[0] >= TURNED
    far = np.sort(away[0, turned])
    paired = len(far) % 2 == 0 and bool((np.diff(far)[::2] < ALIKE).all())
    if not turned.any() or not paired or (away[0] < AT_REST).mean() < LEAST:
        return 0
    count = _beginning((angles_between(local[:1], local) < AT_REST).all(axis=1))
    if not count or not _jumps(local, count)[turned].all():
        return 0
    return count if _jumps(local, count, AT_REST)[~turned].mean() > LEAVE else 0


def _beginning(held: BoolArray) -> int:
    """How many frames (T,) are so before the first that is not; 0 where all are."""
    return 0 if held.all() else int(np.argmin(held))


def _jumps(local: FloatArray, frame: int, least: float = JUMP) -> BoolArray:
    """(J,) which joints (T, J, 3, 3) jump to a frame, by more than the least, rad."""
    return np.asarray(angles_between(local[frame - 1], local[frame]) > least)


def _between(first: FloatArray, second: FloatArray) -> FloatArray:
    """Rotations (..., 3, 3) of the second in the first's frame."""
    return np.asarray(np.swapaxes(first, -1, -2) @ second)
