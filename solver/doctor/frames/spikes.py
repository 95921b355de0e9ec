"""Spikes: a frame, or a few, far from those around them."""

from __future__ import annotations

import numpy as np

from ...arrays import BoolArray, FloatArray
from ...body.anatomy import Part
from ...data.problem import Mend
from ...data.recording import Recording
from ...numerics.rotations import angles_between
from ..figure import Figure
from ..finding import Finding, FindingKind
from ..local_poses import LocalPoses, fourth_differences, spans
from ..repairs import Repairs
from ..slack import slack
from .bursts import bursts
from .steps import AROUND

# From the cubic through the frames around; honest toes that strike the ground are 44° off (a run at
# 60 Hz), and no other joint is 13° off, from 30 Hz on.
SPIKE, TOE_SPIKE = np.radians(14.0), np.radians(50.0)
SPIKE_PLACE = 0.04  # m, the root; honest ones are 8 mm off
RETURNED = 0.5  # of what it leaves by; a frame that is off alone is back in the next
STANDS_OUT = 5.0  # times what the frames around are off


def unsound_spikes(recording: Recording, local: LocalPoses, figure: Figure) -> BoolArray:
    """(T, B) which bones' poses in their parents belong to a frame, or a few, that are off.
    local: the recording's."""
    unsound = np.zeros(recording.heads.shape[:2], bool)
    if len(recording.frames) <= 4:
        return unsound
    bones, rate = figure.bones, recording.rate
    limits = np.array(
        [(TOE_SPIKE if part is Part.TOE else SPIKE) * slack(rate, part) for _, part in figure.parts]
    )
    turns = local.rotations[:, bones]
    off = np.linalg.norm(fourth_differences(turns), axis=(2, 3)) / np.sqrt(2.0)  # rad, if small
    unsound[:, bones] = _single(off, limits) & _returned(
        angles_between(turns[:-1], turns[1:]), angles_between(turns[:-2], turns[2:])
    )
    for root in (b for b, bone in enumerate(recording.bones) if bone.parent < 0):
        heads = local.heads[:, root]
        away = np.linalg.norm(fourth_differences(heads), axis=1)[:, None]
        single = _single(away, np.array(SPIKE_PLACE * slack(rate)))[:, 0]
        unsound[:, root] |= single & _came_back(heads)
    return unsound | bursts(recording, local, figure)


def find_spikes(recording: Recording, figure: Figure) -> Finding | None:
    """Frames far from those around them."""
    local = LocalPoses.of(recording)
    unsound = unsound_spikes(recording, local, figure)
    if not unsound.any():
        return None
    filled = local.filled(unsound)
    turned = (angles_between(filled.rotations, local.rotations) * unsound).max(axis=0)
    moved = (np.linalg.norm(filled.heads - local.heads, axis=2) * unsound).max(axis=0)
    turns = turned.max() / SPIKE > moved.max() / SPIKE_PLACE
    worst = int(np.argmax(turned if turns else moved))
    return Finding(
        FindingKind.SPIKE,
        float(np.degrees(turned[worst]) if turns else 100.0 * moved[worst]),
        "°" if turns else "cm",
        spans(recording, unsound.any(axis=1)),
        recording.bones[worst].name,
        Repairs(mend=(Mend.SPIKES,)),
    )


def _single(off: FloatArray, limit: FloatArray) -> BoolArray:
    """(T, B) where `off` is beyond the limit, most among its neighbours, and stands out."""
    around = np.zeros_like(off)
    for shift in (*range(-AROUND, -2), *range(3, AROUND + 1)):
        moved = np.roll(off, shift, axis=0)
        moved[: max(shift, 0)] = 0.0
        moved[len(off) + min(shift, 0) :] = 0.0
        around = np.maximum(around, np.where(moved > limit, 0.0, moved))
    padded = np.pad(off, ((1, 1), (0, 0)))
    most = (off >= padded[:-2]) & (off >= padded[2:])
    return np.asarray(most & (off > limit) & (off > STANDS_OUT * around))


def _returned(steps: FloatArray, over: FloatArray) -> BoolArray:
    """(T, B) where the frames beside are nearer to each other than to the one between them.

    steps: (T - 1, B) from a frame to the next, over: (T - 2, B) to the next but one.
    """
    inner = over < RETURNED * np.minimum(steps[:-1], steps[1:])
    return np.pad(inner, ((1, 1), (0, 0)))


def _came_back(heads: FloatArray) -> BoolArray:
    """(T,) likewise of places (T, 3), as seen by who moves as fast as the frames beside: at a run a
    frame's way is as long as that to one that is off. False for the first and last two."""
    steps = np.diff(heads, axis=0)
    usual = 0.5 * (steps[:-3] + steps[3:])
    there, back = steps[1:-2] - usual, steps[2:-1] - usual
    away = np.minimum(np.linalg.norm(there, axis=1), np.linalg.norm(back, axis=1))
    return np.pad(np.linalg.norm(there + back, axis=1) < RETURNED * away, 2)
