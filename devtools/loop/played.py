"""A written loop as Blender plays it, over and over."""

from dataclasses import dataclass

import bpy
import numpy as np

from ...bridge.armature.read import record
from ...solver.arrays import FloatArray
from ...solver.data.constants import STANDARD_GRAVITY
from ...solver.transcription.motion import Motion

STEP = 0.1  # frames; less than that, and single precision tells more than the motion


@dataclass(frozen=True)
class Played:
    """An armature that performs a loop. frames: first and last of the cycle; rate: a second.

    bones: those that the motion moves.
    """

    armature: bpy.types.Object
    frames: tuple[float, float]
    rate: float
    bones: tuple[str, ...]

    def points(self, frames: FloatArray) -> FloatArray:
        """(T, P, 3) m, heads of the bones and points a decimetre along them."""
        shown = record(self.armature, frames)
        own = [shown.index(bone) for bone in self.bones]
        heads = shown.heads[:, own]
        return np.concatenate([heads, heads + 0.1 * shown.rotations[:, own][..., 1]], axis=1)

    @property
    def travel(self) -> FloatArray:
        """(3,) m that the pelvis goes in a cycle."""
        first, last = self.points(np.array(self.frames))[:, 0]
        return np.asarray((last - first) * [1.0, 1.0, 0.0])

    def seam_pose(self) -> float:
        """Largest distance of a point at the end from where it began, m, but for the travel."""
        first, last = self.points(np.array(self.frames))
        return _longest(last - first - self.travel)

    def seam_velocity(self) -> float:
        """Largest change of a point's velocity across the seam, m/s: as the keys before it have it,
        against as the repetition after it has it, both to second order."""
        seam = self.frames[1]
        at = self.points(seam + STEP * np.arange(-2.0, 3.0))
        before = 3.0 * at[2] - 4.0 * at[1] + at[0]
        after = -3.0 * at[2] + 4.0 * at[3] - at[4]
        return _longest(after - before) * self.rate / (2.0 * STEP)

    def second_cycle(self) -> float:
        """Largest distance of a point from where it was a cycle before, m, but for the travel."""
        first, last = self.frames
        frames = np.arange(first, last + 0.25, 0.5)
        once, again = self.points(frames), self.points(frames + last - first)
        return _longest(again - once - self.travel)

    def needed_force(self, motion: Motion) -> float:
        """Largest difference between the force that the played motion needs about the seam, of
        whole frames, and the solved one, body weights."""
        character = motion.transcription.character
        frames = self.frames[1] + np.arange(-3.0, 4.0)
        shown = record(self.armature, frames)
        rest = {bone.name: bone.rotation for bone in shown.bones}
        com = np.zeros((len(frames), 3))
        for body in character.bodies:
            bone = shown.index(body.bone)
            turn = shown.rotations[:, bone] @ rest[body.bone].T
            com += body.mass / character.mass * (shown.heads[:, bone] + turn @ body.com)
        needed = np.diff(com, n=2, axis=0) * self.rate**2
        needed[:, 2] += character.gravity
        times = np.mod((frames[1:-1] - self.frames[0]) / self.rate, motion.duration)
        solved = _smoothed(motion, times, 1.0 / self.rate) / character.mass
        return float(np.linalg.norm(needed - solved, axis=1).max()) / STANDARD_GRAVITY


def _smoothed(motion: Motion, times: FloatArray, step: float) -> FloatArray:
    """(T, 3) N: forces as second differences over `step`, s, see them, by weights of a triangle."""
    offsets = (np.arange(200) + 0.5) / 100.0 - 1.0
    weights = 1.0 - np.abs(offsets)
    at = np.mod(times[:, None] + step * offsets, motion.duration)
    forces = motion.forces(at.ravel()).sum(axis=1).reshape(*at.shape, 3)
    return np.asarray(np.einsum("k,tki->ti", weights / weights.sum(), forces))


def _longest(vectors: FloatArray) -> float:
    return float(np.linalg.norm(vectors, axis=-1).max())
