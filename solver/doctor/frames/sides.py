"""Which side a limb belongs to: arms hang outwards from their shoulders, and feet that stand beside
each other have neither legs crossed nor toes turned in."""

from __future__ import annotations

import numpy as np

from ...arrays import BoolArray, FloatArray
from ...data.problem import Mend
from ...data.recording import Recording
from ..limbs import Partners

LEVEL = 0.1  # of a leg, by which the heights of feet that stand beside each other differ
STANDING_SPEED = 0.6  # legs a second, of a foot that stands
FEWEST = 3  # frames
# Of unit ways along the bones, summed over a leg, or of the upper arm: left minus right, to the
# left. Honest recordings have 0.1 and more; of runs, whose feet cross and never stand so, nothing
# is told.
INWARDS = -0.05


def are_wrong(recording: Recording, pair: Partners, limbs: Mend, where: BoolArray) -> bool:
    """Whether limbs point inwards, in the mean of some frames (T,): each is on the other side."""
    ways, roots = pair.ways(recording), recording.heads[:, pair.bones[:, 0]]
    left = roots[:, 0] - roots[:, 1]
    left = left / np.linalg.norm(left, axis=1, keepdims=True)
    outwards = np.einsum("tki,ti->tk", ways[:, 0] - ways[:, 1], left)
    if limbs is Mend.ARMS:
        told, tells = outwards[:, 0], where
    else:
        told, tells = outwards.sum(axis=1), where & _stand_beside(recording, pair)
    return bool(tells.sum() >= FEWEST and told[tells].mean() < INWARDS)


def _stand_beside(recording: Recording, pair: Partners) -> BoolArray:
    """(T,) whether both feet are as low and slow."""
    joints: FloatArray = recording.heads[:, pair.bones[:, :3]]  # hip, knee, ankle of both
    leg = np.median(np.linalg.norm(np.diff(joints, axis=2), axis=3).sum(axis=2))
    ankles = joints[:, :, -1]
    speeds = np.linalg.norm(np.gradient(ankles, recording.times, axis=0), axis=2)
    level = np.abs(ankles[:, 0, 2] - ankles[:, 1, 2]) < LEVEL * leg
    return np.asarray(level & (speeds.max(axis=1) < STANDING_SPEED * leg))
