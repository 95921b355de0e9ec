"""Estimation of the up axis and of the unit of length, where a motion file tells neither."""

import numpy as np

from ...solver.arrays import FloatArray, IntArray
from .motion_clip import MotionClip, UpAxis, forward_kinematics, rest_axes

ACCLAIM_UNIT = 0.0254 / 0.45  # an inch over the scale that the CMU recordings carry
LIKELY_UNITS = (1.0, 0.1, ACCLAIM_UNIT, 0.0254, 0.01, 0.001)  # m
LIKELY_HEIGHT = 1.7  # m
LONGEST_PATH = 1.35  # of a person's height, along the bones from fingertips to toes
SAMPLES = 32
MOST_STRETCHED = 0.05  # of a bone that is one; more, and it moves beside what it hangs on


def guess_up(clip: MotionClip) -> UpAxis:
    """Up axis: along which the head is above the feet; without their names, the tall one."""
    points = _sampled_points(clip)
    names = [joint.name.lower() for joint in clip.joints] * 2
    head = [i for i, name in enumerate(names) if "head" in name]
    feet = [i for i, name in enumerate(names) if any(w in name for w in ("foot", "toe", "ankle"))]
    if head and feet:
        stature = np.mean(points[:, head], axis=(0, 1)) - np.mean(points[:, feet], axis=(0, 1))
    else:
        stature = np.median(np.ptp(points, axis=1), axis=0)
    return "Z" if stature[2] > stature[1] else "Y"


def guess_unit(clip: MotionClip) -> float:
    """Metres per unit: the likely unit that makes the figure nearest in ratio to 1.7 m tall, by the
    lengths of its bones, for who lies or crawls is no smaller."""
    return likely_unit(_longest_path(clip) / LONGEST_PATH)


def likely_unit(height: float) -> float:
    """Metres per unit for a figure of this height in units; 1 where it has no height at all."""
    if height <= 0.0:
        return 1.0
    return min(LIKELY_UNITS, key=lambda unit: abs(np.log(unit * height / LIKELY_HEIGHT)))


def _longest_path(clip: MotionClip) -> float:
    """Units from one tip of the skeleton to another, along its bones, at the longest."""
    lengths, longest = _bone_lengths(clip), 0.0
    tips = (0.0 if joint.tip is None else float(np.linalg.norm(joint.tip)) for joint in clip.joints)
    deepest = np.array([*tips])
    for j, joint in reversed([*enumerate(clip.joints)]):
        longest = max(longest, float(deepest[j]))
        if joint.parent >= 0:
            path = lengths[j] + deepest[j]
            longest = max(longest, float(deepest[joint.parent] + path))
            deepest[joint.parent] = max(deepest[joint.parent], path)
    return longest


def _bone_lengths(clip: MotionClip) -> FloatArray:
    """(J,) units from each joint's parent to it; 0 where that is no bone, but where the figure is:
    of a root, below roots that stand still and carry all else, and of what moves freely."""
    recorded = np.linalg.norm(clip.positions[_sampled(clip)], axis=2)
    lengths = np.median(recorded, axis=0)
    lengths[np.ptp(recorded, axis=0) > MOST_STRETCHED * lengths] = 0.0
    parents = [joint.parent for joint in clip.joints]
    branches = {parent for parent in parents if parents.count(parent) > 1}
    above = {-1}
    for j, parent in enumerate(parents):
        if parent in above:
            lengths[j] = 0.0
            if branches - {-1} and j not in branches:
                above.add(j)
    return np.asarray(lengths)


def _sampled_points(clip: MotionClip) -> FloatArray:
    """(S, 2J, 3) heads, then tails, at instants spread over the clip."""
    heads, rotations = forward_kinematics(clip, _sampled(clip))
    tails = heads + np.einsum("tjab,jb->tja", rotations, rest_axes(clip))
    return np.concatenate([heads, tails], axis=1)


def _sampled(clip: MotionClip) -> IntArray:
    """Frames spread over the clip."""
    total = len(clip.positions)
    return np.asarray(np.unique(np.linspace(0, total - 1, min(SAMPLES, total)).astype(int)))
