"""Keyed bones that cannot follow a solution: constraints pose them otherwise than their keys."""

from __future__ import annotations

from collections.abc import Sequence

import bpy
import numpy as np

from ...solver.arrays import BoolArray, FloatArray
from ..accessors import armature_data, pose_of
from ..armature.channels import proper
from ..armature.pose_basis import place
from ..armature.poses import Poses, sample
from .driven import chain_of
from .posing import Posing

LOOKS = 24  # frames
TURNED = 2e-3  # rad
SHIFTED = 1e-3  # of the bone's length


def held_bones(
    armature: bpy.types.Object, bodies: Sequence[str], frames: FloatArray
) -> tuple[tuple[str, ...], float] | None:
    """Those of the bodies that are not where their channels put them, and the first frame of those
    looked at, of frames (T,), where one is not; None where all are."""
    names = [name for name in bodies if name in _held_at_all(armature)]
    if not names:
        return None
    at = frames[np.unique(np.linspace(0, len(frames) - 1, LOOKS).round().astype(int))]
    poses, posing, bases = sample(armature, at), Posing(armature, names, ()), []
    with posing.kept():
        for frame in at:
            posing.go_to(float(frame))
            bases.append(posing.bases())
    own = zip(names, np.swapaxes(bases, 0, 1), strict=True)
    off = np.stack([_off(armature, poses, name, each) for name, each in own])
    if not off.any():
        return None
    first = float(at[np.flatnonzero(off.any(axis=0))[0]])
    return tuple(name for name, each in zip(names, off, strict=True) if each.any()), first


def _held_at_all(armature: bpy.types.Object) -> set[str]:
    """Bones with constraints of any kind that are not muted, or in inverse kinematics' chains."""
    found = set[str]()
    for bone in pose_of(armature).bones:
        for constraint in bone.constraints:
            if constraint.is_valid and not constraint.mute:
                found.update((bone.name, *chain_of(bone, constraint)))
    return found


def _off(armature: bpy.types.Object, poses: Poses, name: str, bases: FloatArray) -> BoolArray:
    """(T,) whether a bone is elsewhere than its channels (T, 4, 4) put it under its parent."""
    bone = armature_data(armature).bones[name]
    own, channels = poses.matrices[:, poses.bones.index(name)], bases.copy()
    if bone.use_connect:  # its location does not count
        channels[:, :3, 3] = 0.0
    carrier = bone.parent
    above = None if carrier is None else poses.matrices[:, poses.bones.index(carrier.name)]
    put = place(bone, above, channels)
    turns = np.swapaxes(proper(put[:, :3, :3]), 1, 2) @ proper(own[:, :3, :3])
    turned = np.linalg.norm(turns - np.eye(3), axis=(1, 2)) > np.sqrt(2.0) * TURNED
    shifted = np.linalg.norm(put[:, :3, 3] - own[:, :3, 3], axis=1) > SHIFTED * bone.length
    return np.asarray(turned | shifted)
