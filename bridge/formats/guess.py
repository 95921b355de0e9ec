"""Estimation of the up axis and of the unit of length, where a motion file tells neither."""

from typing import get_args

import numpy as np

from ...solver.arrays import FloatArray, IntArray
from .motion_clip import MotionClip, UpAxis, forward_kinematics, rest_axes, rest_heads

ACCLAIM_UNIT = 0.0254 / 0.45  # an inch over the scale that the CMU recordings carry
LIKELY_UNITS = (1.0, 0.1, ACCLAIM_UNIT, 0.0254, 0.01, 0.001)  # m
LIKELY_HEIGHT = 1.7  # m
LONGEST_PATH = 1.35  # of a person's height, along the bones from fingertips to toes
SAMPLES = 32
FEET = ("foot", "toe", "ankle")
UPRIGHT = 0.8  # of the way from feet to head, along one axis, of a rest pose that stands, and
TALL = 0.45  # of the longest path: who stands has 0.55 to 0.65, bones that all follow an axis less
SUNK = 0.01  # of it, below 0, of no body's lowest joints that a floor at 0 carries
MOST_STRETCHED = 0.05  # of a bone that is one; more, and it moves beside what it hangs on

_INDEX: dict[UpAxis, int] = {"Y": 1, "Z": 2}


def guess_up(clip: MotionClip) -> UpAxis:
    """Up axis: along which the head is above the feet in the motion; without their names, the tall
    one. Where an upright rest pose says another, the figure lies or stands on its hands, or its
    root's rotation turns all upright: the floor tells which. Who is upside down in between stands
    upright at the ends of the clip."""
    points = _sampled_points(clip, _sampled(clip))
    stature = _stature(clip, points)
    moving: UpAxis = "Z" if stature[2] > stature[1] else "Y"
    rest = _rest_up(clip)
    if rest == moving:
        return moving
    ends = _up_at_ends(clip, points)
    if rest is None or rest == ends:
        return ends or moving
    upside_down = -stature[_INDEX[rest]] > abs(stature[_INDEX[moving]])
    return rest if upside_down or _lies(clip, points, rest, moving) else moving


def guess_unit(clip: MotionClip) -> float:
    """Metres per unit: the likely unit that makes the figure nearest in ratio to 1.7 m tall, by the
    lengths of its bones, for who lies or crawls is no smaller."""
    return likely_unit(_longest_path(clip) / LONGEST_PATH)


def likely_unit(height: float) -> float:
    """Metres per unit for a figure of this height in units; 1 where it has no height at all."""
    if height <= 0.0:
        return 1.0
    return min(LIKELY_UNITS, key=lambda unit: abs(np.log(unit * height / LIKELY_HEIGHT)))


def _rest_up(clip: MotionClip) -> UpAxis | None:
    """The axis along which the rest pose stands; None where it does not clearly, as where all bones
    follow one axis, or where names do not tell head and feet."""
    heads = rest_heads(clip)
    points = np.concatenate([heads, heads + rest_axes(clip)])[None]
    return _standing(clip, points, _longest_path(clip))


def _up_at_ends(clip: MotionClip, points: FloatArray) -> UpAxis | None:
    """The axis along which the figure mostly stands when it stands upright in its first and its
    last second, if it is tall along that in all points (S, 2J, 3), upright or upside down; else
    None."""
    second = max(round(1.0 / clip.frame_time), 1)
    parts = (slice(None, second), slice(-second, None))
    ends = np.concatenate([_sampled_points(clip, _sampled(clip, part)) for part in parts])
    path = _longest_path(clip)
    upright = [axis for each in ends if (axis := _standing(clip, each[None], path))]
    if not upright:
        return None
    tall = np.abs(_statures(clip, points)).mean(axis=0)
    along: UpAxis = "Z" if tall[2] > tall[1] else "Y"
    return along if 2 * upright.count(along) > len(upright) else None


def _standing(clip: MotionClip, points: FloatArray, path: float) -> UpAxis | None:
    """The axis along which a figure with points (S, 2J, 3), and so long a path along its bones,
    clearly stands upright; else None."""
    if not all(_ends(clip)):
        return None
    stature = _stature(clip, points)
    tall = max(UPRIGHT * float(np.linalg.norm(stature)), TALL * path)
    return next((axis for axis in get_args(UpAxis) if stature[_INDEX[axis]] > tall), None)


def _lies(clip: MotionClip, points: FloatArray, rest: UpAxis, moving: UpAxis) -> bool:
    """Whether the lowest joints are on a floor at 0 if the rest pose's axis is up, rather than if
    the other one is, along which the figure lies or stands. points: (S, 2J, 3), joints first."""
    lowest = points[:, : len(clip.joints)].min(axis=1)
    under, beside = lowest[:, _INDEX[rest]], lowest[:, _INDEX[moving]]
    if np.median(under) < -SUNK * _longest_path(clip):
        return False
    return bool(np.median(np.abs(under)) < np.median(np.abs(beside)))


def _stature(clip: MotionClip, points: FloatArray) -> FloatArray:
    """(3,) from feet to head of points (S, 2J, 3); without their names, how far all extend."""
    if not all(_ends(clip)):
        return np.asarray(np.median(np.ptp(points, axis=1), axis=0))
    return np.asarray(_statures(clip, points).mean(axis=0))


def _statures(clip: MotionClip, points: FloatArray) -> FloatArray:
    """(S, 3) from feet to head, whose names are known, of points (S, 2J, 3)."""
    head, feet = _ends(clip)
    return np.asarray(points[:, head].mean(axis=1) - points[:, feet].mean(axis=1))


def _ends(clip: MotionClip) -> tuple[list[int], list[int]]:
    """Indices among heads and tails (2J,) of the head's, and of the feet's."""
    names = [joint.name.lower() for joint in clip.joints] * 2
    head = [i for i, name in enumerate(names) if "head" in name]
    return head, [i for i, name in enumerate(names) if any(w in name for w in FEET)]


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


def _sampled_points(clip: MotionClip, frames: IntArray) -> FloatArray:
    """(S, 2J, 3) heads, then tails, at so many frames."""
    heads, rotations = forward_kinematics(clip, frames)
    tails = heads + np.einsum("tjab,jb->tja", rotations, rest_axes(clip))
    return np.concatenate([heads, tails], axis=1)


def _sampled(clip: MotionClip, part: slice = slice(None)) -> IntArray:
    """Frames spread over the clip, or over a part of it."""
    frames = np.arange(len(clip.positions))[part]
    spread = np.linspace(0, len(frames) - 1, min(SAMPLES, len(frames)))
    return np.asarray(frames[np.unique(spread.astype(int))])
