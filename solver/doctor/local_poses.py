"""Poses of bones in their parents' frames, where each bone's faults are its own."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..data.recording import Recording
from ..numerics.rotations import rotation_matrix, rotation_vector
from ..numerics.runs import runs

TOGETHER = 512  # frames of all bones, which a processor's cache holds
SUPPORT = 2  # sound frames on each side that a gap is filled from


@dataclass(frozen=True)
class LocalPoses:
    """rotations: (T, B, 3, 3) and heads: (T, B, 3) m, in the parent's frame; a root's in the
    world's."""

    rotations: FloatArray
    heads: FloatArray

    @staticmethod
    def of(recording: Recording) -> LocalPoses:
        """Of a recording."""
        rotations, heads = recording.rotations.copy(), recording.heads.copy()
        parents = np.array([bone.parent for bone in recording.bones])
        led = np.flatnonzero(parents >= 0)
        for start in range(0, len(heads), TOGETHER):
            part = slice(start, start + TOGETHER)
            turned, placed = recording.rotations[part], recording.heads[part]
            up = np.swapaxes(turned[:, parents[led]], -1, -2)
            rotations[part, led] = up @ turned[:, led]
            apart = placed[:, led] - placed[:, parents[led]]
            heads[part, led] = np.einsum("tbij,tbj->tbi", up, apart)
        return LocalPoses(rotations, heads)

    def posed(self, recording: Recording) -> Recording:
        """The recording with these poses (forward kinematics)."""
        rotations, heads = self.rotations.copy(), self.heads.copy()
        for b, bone in enumerate(recording.bones):
            if bone.parent >= 0:
                up = rotations[:, bone.parent]
                rotations[:, b] = up @ self.rotations[:, b]
                heads[:, b] = heads[:, bone.parent] + np.einsum("tij,tj->ti", up, self.heads[:, b])
        return replace(recording, rotations=rotations, heads=heads)

    def filled(self, unsound: BoolArray) -> LocalPoses:
        """With what is unsound (T, B) interpolated from the sound frames around it."""
        rotations, heads = self.rotations.copy(), self.heads.copy()
        for b in np.flatnonzero(unsound.any(axis=0)):
            sound = np.flatnonzero(~unsound[:, b])
            for t in np.flatnonzero(unsound[:, b]) if len(sound) else ():
                near, weights = lagrange(sound, int(t))
                base = self.rotations[near[0], b]
                turns = rotation_vector(base.T @ self.rotations[near, b])
                rotations[t, b] = base @ rotation_matrix(weights @ turns)
                heads[t, b] = weights @ self.heads[near, b]
        return LocalPoses(rotations, heads)


def fourth_differences(samples: FloatArray) -> FloatArray:
    """(T, ...) how far each sample (T, ...) is from the cubic through its four neighbours.

    0 for the first and last two. What is smooth leaves next to nothing, a single sample that is s
    off leaves s, white noise 1.4 times itself.
    """
    out = np.zeros_like(samples)
    if len(samples) > 4:
        near, far = samples[1:-3] + samples[3:-1], samples[:-4] + samples[4:]
        out[2:-2] = samples[2:-2] - (4.0 * near - far) / 6.0
    return out


def spans(recording: Recording, mask: BoolArray) -> tuple[tuple[float, float], ...]:
    """First and last scene frame of every run of True in (T,)."""
    frames = recording.frames
    return tuple((float(frames[a]), float(frames[b])) for a, b in runs(mask))


def lagrange(sound: IntArray, t: int) -> tuple[IntArray, FloatArray]:
    """Indices of the sound frames around frame t, and their weights in the polynomial there."""
    at = int(np.searchsorted(sound, t))
    near = sound[max(at - SUPPORT, 0) : at + SUPPORT]
    if at < SUPPORT or at + SUPPORT > len(sound):  # a polynomial that leads outwards runs away
        near = sound[max(at - 1, 0) : at + 1]
        near = near if len(near) == 2 and near[0] < t < near[1] else near[:1]
    weights = [
        np.prod([(t - other) / (each - other) for other in near if other != each]) for each in near
    ]
    return near, np.array(weights)
