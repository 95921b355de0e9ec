"""Trembling: joints that jitter from frame to frame, as video capture leaves them."""

from __future__ import annotations

import numpy as np

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
    turning = sorted({*_carriers(recording, figure), *roots})
    width, far = WIDTH * recording.rate, reach(recording.rate)
    for t in range(count):
        near = np.arange(max(t - far, 0), min(t + far, count - 1) + 1)
        u = (near - t) / width
        root = np.exp(-0.25 * u**2)  # of the weight
        weights = root * np.linalg.pinv(root[:, None] * u[:, None] ** np.arange(4))[0]
        heads[t, roots] = np.einsum("k,kbi->bi", weights, local.heads[near][:, roots])
        here = local.rotations[t, turning]
        turns = rotation_vector(np.swapaxes(here, -1, -2) @ local.rotations[near][:, turning])
        rotations[t, turning] = here @ rotation_matrix(np.einsum("k,kbi->bi", weights, turns))
    return LocalPoses(rotations, heads).posed(recording)


def _carriers(recording: Recording, figure: Figure) -> set[int]:
    """The figure's bones, and all that carry them: what trembles between hips and thighs, and is no
    part of the body, moves the legs."""
    found = set(figure.bones)
    for bone in reversed(range(len(recording.bones))):  # parents come before their children
        if bone in found and recording.bones[bone].parent >= 0:
            found.add(recording.bones[bone].parent)
    return found
