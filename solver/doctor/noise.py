"""Trembling: joints that jitter from frame to frame, as video capture leaves them."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..data.problem import Mend
from ..data.recording import Recording
from ..numerics.rotations import quaternion, rotation_matrix, turns_between
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
    local = LocalPoses.of(recording)
    rotations, heads = local.rotations.copy(), local.heads.copy()
    roots = [b for b, bone in enumerate(recording.bones) if bone.parent < 0]
    turning = sorted({*_carriers(recording, figure), *roots})
    heads[:, roots], rotations[:, turning] = _regressed(
        local.heads[:, roots], local.rotations[:, turning], recording.rate
    )
    return LocalPoses(rotations, heads).posed(recording)


def _regressed(
    places: FloatArray, rotations: FloatArray, rate: float
) -> tuple[FloatArray, FloatArray]:
    """Places (T, R, 3) and rotations (T, B, 3, 3), smoothed. rate: frames a second."""
    far = min(reach(rate), len(places) - 1)
    weights = _weights(len(places), far, WIDTH * rate)[..., None, None]
    turned, placed = np.zeros(rotations.shape[:-1]), weights[:, far] * places
    quaternions = quaternion(rotations)
    for lag in range(1, far + 1):  # each two frames at once, for both
        turns = turns_between(quaternions[:-lag], quaternions[lag:])
        onwards, back = weights[:-lag, far + lag], weights[lag:, far - lag]
        turned[:-lag] += onwards * turns
        turned[lag:] -= back * turns  # a turn's axis is the same in both frames
        placed[:-lag] += onwards * places[lag:]
        placed[lag:] += back * places[:-lag]
    return placed, rotations @ rotation_matrix(turned)


def _weights(count: int, far: int, width: float) -> FloatArray:
    """(count, 2 far + 1) of the frames from `far` before to `far` after each, in the value there of
    a cubic through them; 0 of those beyond the ends. width: frames, of the Gaussian."""
    before = np.minimum(np.arange(count), far)
    after = before[::-1]
    found = np.zeros((count, 2 * far + 1))
    for least, most in sorted({*zip(before.tolist(), after.tolist(), strict=True)}):
        u = np.arange(-least, most + 1) / width
        root = np.exp(-0.25 * u**2)  # of the Gaussian
        cubic = root * np.linalg.pinv(root[:, None] * u[:, None] ** np.arange(4))[0]
        found[(before == least) & (after == most), far - least : far + most + 1] = cubic
    return found


def _carriers(recording: Recording, figure: Figure) -> set[int]:
    """The figure's bones, and all that carry them: what trembles between hips and thighs, and is no
    part of the body, moves the legs."""
    found = set(figure.bones)
    for bone in reversed(range(len(recording.bones))):  # parents come before their children
        if bone in found and recording.bones[bone].parent >= 0:
            found.add(recording.bones[bone].parent)
    return found
