"""Trembling: joints that jitter from frame to frame, as video capture leaves them."""

from __future__ import annotations

from functools import cache

import numpy as np

from ..arrays import FloatArray
from ..data.problem import Mend
from ..data.recording import Recording
from ..numerics.rotations import rotation_matrix, rotation_vector
from .figure import Figure
from .finding import Finding, FindingKind
from .local_poses import LocalPoses, fourth_differences
from .repairs import Repairs
from .slack import slack

TREMBLING = 0.0015  # m, rms of a joint's place; laboratories' recordings have a tenth to a half
ALTERNATING = -0.5  # correlation of what neighbouring frames are off; noise has -0.8
GAIN = np.sqrt(70.0 / 36.0)  # of white noise by a fourth difference
DEVIATION = 0.6745  # of a Gaussian: its median's, in standard deviations
# s, of the smoothing's Gaussian weight; of 3 mm and 1° it leaves least at 24 to 120 Hz alike.
WIDTH = 0.06
REACH = 3.0  # widths on each side


def find_noise(recording: Recording, figure: Figure) -> Finding | None:
    """White noise on the places of the body's joints."""
    if len(recording.frames) < 8:
        return None
    bones = figure.bones
    off = fourth_differences(recording.heads[:, bones])[2:-2]
    rms = np.sqrt(np.mean(np.median(np.abs(off), axis=0) ** 2, axis=1)) / DEVIATION / GAIN
    power = np.einsum("tbi,tbi->b", off, off)
    alternation = np.einsum("tbi,tbi->b", off[:-1], off[1:]) / np.maximum(power, 1e-15)
    usual = float(np.median(rms))
    if usual < TREMBLING * slack(recording.rate) or float(np.median(alternation)) > ALTERNATING:
        return None
    worst = recording.bones[bones[int(np.argmax(rms))]].name
    remedy = Repairs(mend=(Mend.NOISE,))
    return Finding(FindingKind.NOISE, 1e3 * usual, "mm", part=worst, remedy=remedy)


def reach(rate: float) -> int:
    """Frames on each side of one that it is smoothed with, of so many a second."""
    return int(np.ceil(REACH * WIDTH * rate))


def smoothed(recording: Recording, figure: Figure) -> Recording:
    """By local regression (Savitzky & Golay 1964): cubics with Gaussian weights.

    Rotations in the chart about the frame itself, where a cubic is a fair curve.
    """
    local, count = LocalPoses.of(recording), len(recording.frames)
    rotations, heads = local.rotations.copy(), local.heads.copy()
    roots = [b for b, bone in enumerate(recording.bones) if bone.parent < 0]
    weights = _weights(count, reach(recording.rate), WIDTH * recording.rate)
    heads[:, roots] = _weighed(weights, local.heads[:, roots])
    for bone in {*_carriers(recording, figure), *roots}:
        turns = _weighed_turns(weights, local.rotations[:, bone])
        rotations[:, bone] = local.rotations[:, bone] @ rotation_matrix(turns)
    return LocalPoses(rotations, heads).posed(recording)


def _weights(count: int, far: int, width: float) -> FloatArray:
    """(T, 2 far + 1), of the frames about each of T; 0 of those that are not there.

    far, width: in frames.
    """
    weights = np.zeros((count, 2 * far + 1))

    @cache
    def cubic(before: int, after: int) -> FloatArray:
        """Its value at the frame, of so many about it."""
        u = np.arange(-before, after + 1) / width
        root = np.exp(-0.25 * u**2)  # of the weight
        return np.asarray(root * np.linalg.pinv(root[:, None] * u[:, None] ** np.arange(4))[0])

    for t in range(count):
        before, after = min(t, far), min(count - 1 - t, far)
        weights[t, far - before : far + after + 1] = cubic(before, after)
    return weights


def _weighed(weights: FloatArray, places: FloatArray) -> FloatArray:
    """(T, B, 3), of places (T, B, 3)."""
    far, count = weights.shape[1] // 2, len(places)
    total = weights[:, far, None, None] * places
    for k in range(1, min(far, count - 1) + 1):
        total[:-k] += weights[:-k, far + k, None, None] * places[k:]
        total[k:] += weights[k:, far - k, None, None] * places[:-k]
    return total


def _weighed_turns(weights: FloatArray, rotations: FloatArray) -> FloatArray:
    """(T, 3) rad, of the turns from each of rotations (T, 3, 3) to those about it; the turn back
    is minus the turn there."""
    far, count = weights.shape[1] // 2, len(rotations)
    total = np.zeros((count, 3))
    for k in range(1, min(far, count - 1) + 1):
        turns = rotation_vector(np.swapaxes(rotations[:-k], 1, 2) @ rotations[k:])
        total[:-k] += weights[:-k, far + k, None] * turns
        total[k:] -= weights[k:, far - k, None] * turns
    return total


def _carriers(recording: Recording, figure: Figure) -> set[int]:
    """The figure's bones, and all that carry them: what trembles between hips and thighs, and is no
    part of the body, moves the legs."""
    found = set(figure.bones)
    for bone in reversed(range(len(recording.bones))):  # parents come before their children
        if bone in found and recording.bones[bone].parent >= 0:
            found.add(recording.bones[bone].parent)
    return found
