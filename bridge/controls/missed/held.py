"""Keyed bones that cannot follow a solution: constraints pose them otherwise than their keys."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, nullcontext
from functools import partial

import bpy
import numpy as np

from ....solver.arrays import BoolArray, FloatArray
from ...accessors import armature_data, pose_of
from ...armature.channels import proper
from ...armature.incremental import Incremental, in_slices
from ...armature.pose_basis import place
from ..driven import chain_of
from ..posing import Posing

LOOKS = 24  # frames
TURNED = 2e-3  # rad
SHIFTED = 1e-3  # of the bone's length


def held_bones(
    armature: bpy.types.Object,
    bodies: Sequence[str],
    frames: FloatArray,
    showing: Callable[[], AbstractContextManager[object]] = nullcontext,
) -> Incremental[dict[str, float]]:
    """Those of the bodies that are not where their channels put them, each with the first frame of
    those looked at, of frames (T,), where it is not; in slices. showing: as of `in_slices`."""
    with showing():
        held = _held_at_all(armature)
    names = [name for name in bodies if name in held]
    if not names:
        return {}
    at = frames[np.unique(np.linspace(0, len(frames) - 1, LOOKS).round().astype(int))]
    off = np.concatenate((yield from in_slices(at, partial(_off, armature, names), showing)))
    return {
        name: float(at[each.argmax()])
        for name, each in zip(names, off.T, strict=True)
        if each.any()
    }


def _held_at_all(armature: bpy.types.Object) -> set[str]:
    """Bones with constraints of any kind that are not muted, or in inverse kinematics' chains."""
    found = set[str]()
    for bone in pose_of(armature).bones:
        for constraint in bone.constraints:
            if constraint.is_valid and not constraint.mute:
                found.update((bone.name, *chain_of(bone, constraint)))
    return found


def _off(armature: bpy.types.Object, names: Sequence[str], frames: FloatArray) -> BoolArray:
    """(T, N) whether bones are elsewhere than their channels put them under their parents."""
    bones = [armature_data(armature).bones[name] for name in names]
    above = [bone.parent.name if bone.parent else bone.name for bone in bones]
    posing, found = Posing(armature, names, above), []
    with posing.kept():
        for frame in frames:
            posing.go_to(float(frame))
            found.append((posing.bases(), *posing.shown()))
    every = [np.array(each) for each in zip(*found, strict=True)]  # (T, N, 4, 4)
    return np.stack(
        [_is_off(bone, *(each[:, n] for each in every)) for n, bone in enumerate(bones)], axis=1
    )


def _is_off(
    bone: bpy.types.Bone, channels: FloatArray, own: FloatArray, above: FloatArray
) -> BoolArray:
    """(T,) whether a bone's poses (T, 4, 4) are others than its channels and its parent's poses,
    which do not count where it has none, put it in."""
    if bone.use_connect:  # its location does not count
        channels = channels.copy()
        channels[:, :3, 3] = 0.0
    put = place(bone, above if bone.parent else None, channels)
    turns = np.swapaxes(proper(put[:, :3, :3]), 1, 2) @ proper(own[:, :3, :3])
    turned = np.linalg.norm(turns - np.eye(3), axis=(1, 2)) > np.sqrt(2.0) * TURNED
    shifted = np.linalg.norm(put[:, :3, 3] - own[:, :3, 3], axis=1) > SHIFTED * bone.length
    return np.asarray(turned | shifted)
