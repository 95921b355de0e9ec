"""Joints: a rest pose, spikes, flips, limbs exchanged, noise, a bone that grows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ....solver.arrays import FloatArray
from ....solver.body.anatomy import Part
from ....solver.data.problem import Mend
from ....solver.data.recording import Recording
from ....solver.doctor.figure import figure_of
from ....solver.doctor.finding import FindingKind
from ....solver.doctor.frames.exchanges import KINDS, LIMBS
from ....solver.doctor.limbs import partners
from ....solver.doctor.local_poses import LocalPoses
from ....solver.numerics.rotations import axis_rotation, rotation_matrix
from .damage import VIDEO_RATE, Damage, Damaged, at_rate, bone_of


def begun_at_rest(frames: int, arms: float = 0.0) -> Damage:
    """The rest pose on the first frames. arms: °, by which both are turned in it: as in a T pose
    where the rest hangs them."""

    def do(recording: Recording, _: np.random.Generator) -> Damaged:
        rotations, heads = recording.rotations.copy(), recording.heads.copy()
        rotations[:frames] = np.stack([bone.rotation for bone in recording.bones])
        heads[:frames] = np.stack([bone.head for bone in recording.bones])
        damaged = replace(recording, rotations=rotations, heads=heads)
        local, bones = LocalPoses.of(damaged), figure_of(recording).of(Part.UPPER_ARM)
        for bone, degrees in zip(bones, (arms, -arms), strict=True):
            turn = axis_rotation(0, np.radians(degrees))
            local.rotations[:frames, bone] = local.rotations[:frames, bone] @ turn
        return Damaged(local.posed(damaged), recording.part(slice(frames, None)))

    name = f"rest pose{', arms turned' if arms else ''}, {frames} frames"
    return Damage(name, FindingKind.BIND_POSE, do)


def ended_at_rest(frames: int) -> Damage:
    """The rest pose on the last frames."""

    def do(recording: Recording, _: np.random.Generator) -> Damaged:
        rotations, heads = recording.rotations.copy(), recording.heads.copy()
        rotations[-frames:] = np.stack([bone.rotation for bone in recording.bones])
        heads[-frames:] = np.stack([bone.head for bone in recording.bones])
        damaged = replace(recording, rotations=rotations, heads=heads)
        return Damaged(damaged, recording.part(slice(None, -frames)))

    return Damage(f"rest pose on the last {frames} frames", FindingKind.BIND_POSE, do)


def spiked(degrees: float) -> Damage:
    """Five joints off, each on one frame."""

    def do(recording: Recording, rng: np.random.Generator) -> Damaged:
        figure, local = figure_of(recording), LocalPoses.of(recording)
        bones = [bone for bone, part in figure.parts if part is not Part.TOE]
        for frame in rng.choice(np.arange(4, len(recording.frames) - 4), 5, replace=False):
            axis = rng.normal(size=3)
            turn = np.radians(degrees) * axis / np.linalg.norm(axis)
            bone = rng.choice(bones)
            local.rotations[frame, bone] = local.rotations[frame, bone] @ rotation_matrix(turn)
        return Damaged(local.posed(recording), recording)

    return Damage(f"spikes of {degrees:g}°", FindingKind.SPIKE, do)


def burst(frames: int) -> Damage:
    """An arm off by 50° on some frames."""

    def do(recording: Recording, rng: np.random.Generator) -> Damaged:
        local, bone = LocalPoses.of(recording), bone_of(recording, Part.UPPER_ARM)
        first = int(rng.integers(12, len(recording.frames) - frames - 12))
        axis = rng.normal(size=3)
        turn = rotation_matrix(np.radians(50.0) * axis / np.linalg.norm(axis))
        own = local.rotations[first : first + frames, bone]
        local.rotations[first : first + frames, bone] = own @ turn
        return Damaged(local.posed(recording), recording)

    return Damage(f"spike of 50°, {frames} frames", FindingKind.SPIKE, do)


def ragged(frames: int) -> Damage:
    """An arm off by 60°, each time elsewhere, on the last frames, where capture loses it."""

    def do(recording: Recording, rng: np.random.Generator) -> Damaged:
        local, bone = LocalPoses.of(recording), bone_of(recording, Part.UPPER_ARM)
        axes = rng.normal(size=(frames, 3))
        turns = np.radians(60.0) * axes / np.linalg.norm(axes, axis=1, keepdims=True)
        local.rotations[-frames:, bone] = local.rotations[-frames:, bone] @ rotation_matrix(turns)
        return Damaged(local.posed(recording), recording)

    return Damage(f"the last {frames} frames ragged", FindingKind.JUMP, do)


def exchanged(frames: int, *limbs: Mend, last: bool = False, angles: bool = False) -> Damage:
    """Left and right limbs exchanged on some frames, from where they differ most, or on the last:
    as video capture mistakes them, each bone 5° off, for it exchanges nothing exactly, or their
    angles, as programs do."""

    def do(recording: Recording, rng: np.random.Generator) -> Damaged:
        figure, damaged = figure_of(recording), recording
        pairs = [partners(recording, figure, LIMBS[each])[angles] for each in limbs]
        apart = np.linalg.norm(np.diff(pairs[0].ways(recording)[:, :, 0], axis=1), axis=(1, 2))
        count = len(recording.frames)
        first = count - frames if last else 12 + int(np.argmax(apart[12 : -frames - 12]))
        where = (np.arange(count) >= first) & (np.arange(count) < first + frames)
        for pair in pairs:
            damaged = pair.exchanged(damaged, where)
        local = LocalPoses.of(damaged)
        for bone in () if angles else np.concatenate([pair.bones.ravel() for pair in pairs]):
            axis = rng.normal(size=3)
            off = rotation_matrix(np.radians(5.0) * axis / np.linalg.norm(axis))
            local.rotations[where, bone] = local.rotations[where, bone] @ off
        return Damaged(local.posed(damaged), recording)

    what = " and ".join(each.value.removeprefix("exchanged ") for each in limbs)
    kinds = [KINDS[each] for each in limbs]
    which = f"{'the last ' if last else ''}{frames} frames"
    name = f"{what}{' by angles' if angles else ''} exchanged, {which}"
    return Damage(name, kinds[0], do, tuple(kinds[1:]))


def flipped(frames: int, of_parent: bool = False) -> Damage:
    """A thigh turned by half a turn about its own axis, or one of its parent."""

    def do(recording: Recording, rng: np.random.Generator) -> Damaged:
        local = LocalPoses.of(recording)
        bone = bone_of(recording, Part.THIGH)
        first = int(rng.integers(10, len(recording.frames) - frames - 10))
        inside = local.rotations[first : first + frames, bone]
        turned = axis_rotation(2, np.pi) @ inside if of_parent else inside @ axis_rotation(1, np.pi)
        local.rotations[first : first + frames, bone] = turned
        return Damaged(local.posed(recording), recording)

    about = " about its parent's axis" if of_parent else ""
    return Damage(f"thigh flipped{about}, {frames} frames", FindingKind.FLIP, do)


def wrapped(part: Part, frames: int, channel: int = 0, rate: float | None = None) -> Damage:
    """An Euler channel (0 to 2: Z, X, Y) that leaps from 180° to -180°, and was interpolated over
    some frames. rate: Hz, at which the recording is sampled first; None: its own."""

    def do(recording: Recording, rng: np.random.Generator) -> Damaged:
        original = recording if rate is None else at_rate(recording, rate)
        local, bone, count = LocalPoses.of(original), bone_of(original, part), len(original.frames)
        ramp = np.clip(np.arange(count) - rng.integers(8, count - frames - 8), 0, frames + 1)
        angles = _euler(local.rotations[:, bone])
        angles[:, channel] -= 2.0 * np.pi * ramp / (frames + 1)
        z, x, y = (axis_rotation(a, angles[:, i]) for i, a in enumerate((2, 0, 1)))
        local.rotations[:, bone] = z @ x @ y
        return Damaged(local.posed(original), original)

    at = "" if rate is None else f", {rate:g} Hz"
    name = f"{part.value} turned around, {frames} frames{at}"
    return Damage(name, FindingKind.FULL_TURN, do)


def _euler(rotations: FloatArray) -> FloatArray:
    """(T, 3) rad, of rotations (T, 3, 3) about Z, X and Y; not of those at gimbal lock."""
    x = np.arcsin(np.clip(rotations[:, 2, 1], -1.0, 1.0))
    z = np.arctan2(-rotations[:, 0, 1], rotations[:, 1, 1])
    y = np.arctan2(-rotations[:, 2, 0], rotations[:, 2, 2])
    return np.stack([z, x, y], axis=1)


def noisy(millimetres: float, degrees: float, rate: float = VIDEO_RATE) -> Damage:
    """As video capture gives it: white noise on the root's place and on all joints."""

    def do(recording: Recording, rng: np.random.Generator) -> Damaged:
        original = at_rate(recording, rate)
        local = LocalPoses.of(original)
        turns = np.radians(degrees) * rng.normal(size=(*local.rotations.shape[:2], 3))
        rotations, heads = local.rotations @ rotation_matrix(turns), local.heads
        for b, bone in enumerate(original.bones):
            if bone.parent < 0:
                heads[:, b] += 1e-3 * millimetres * rng.normal(size=(len(heads), 3))
        return Damaged(LocalPoses(rotations, heads).posed(original), original)

    name = f"{rate:g} Hz, {millimetres:g} mm and {degrees:g}° noise"
    return Damage(name, FindingKind.NOISE, do)


def stretched(share: float) -> Damage:
    """A shank that grows by a share of its length in the middle of the clip, and back."""

    def do(recording: Recording, _: np.random.Generator) -> Damaged:
        local, foot = LocalPoses.of(recording), bone_of(recording, Part.FOOT)
        grown = 1.0 + share * np.sin(np.pi * np.linspace(0.0, 1.0, len(recording.frames))) ** 8
        local.heads[:, foot] *= grown[:, None]
        return Damaged(local.posed(recording), recording)

    return Damage(f"shank {100 * share:+g} %", FindingKind.BONE_LENGTH, do)
