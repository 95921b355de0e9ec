"""Rigify's generated human with the actor's jump on its controls, in FK or in IK."""

from __future__ import annotations

import bpy
import numpy as np
from mathutils import Matrix

from ....bridge.accessors import armature_data, pose_of, present
from ....bridge.armature import fcurves
from ....bridge.armature.channels import channels, proper
from ....bridge.armature.poses import Poses, sample
from ....solver.arrays import FloatArray
from ....solver.numerics.rotations import rotation_matrix, unit
from ..actor import Actor
from ..generated import SWITCH, generated_human, perform

LIMBS = (("upper_arm", "forearm", "hand"), ("thigh", "shin", "foot", "toe"))
TWISTS = 3


def rigify_human(actor: Actor, *, ik: bool, rate: int) -> bpy.types.Object:
    """The generated rig in an empty scene of its own, with the actor's jump.

    In IK its limbs' controls are put where FK has the limbs, as the rig's own button does.
    """
    rig = generated_human(actor, arms=1.0, legs=1.0)
    present(bpy.context.scene).render.fps = rate
    perform(rig, actor)
    if ik:
        _snap(rig, actor.frames)
    return rig


def _snap(rig: bpy.types.Object, frames: FloatArray) -> None:
    """Keys the limbs' IK controls instead of their FK controls."""
    poses = sample(rig, frames)
    rests = {bone.name: np.array(bone.matrix_local) for bone in armature_data(rig).bones}
    limbs = [tuple(f"{name}.{s}" for name in chain) for chain in LIMBS for s in "LR"]
    wanted = {}
    for first, _, *ends in limbs:
        for bone in (first, *ends):
            offset = np.linalg.solve(rests[_fk(bone)], rests[_ik(bone)])
            wanted[_ik(bone)] = _matrices(poses, _fk(bone)) @ offset
    _forget(rig, {_fk(bone) for limb in limbs for bone in limb})
    for posed in pose_of(rig).bones:
        if posed.get(SWITCH) is not None:
            posed[SWITCH] = 0.0
    rig.update_tag()
    _key_controls(rig, frames, wanted)
    for _ in range(TWISTS):  # until knees and elbows point where they did
        now, twisted = sample(rig, frames), {}
        for limb in limbs:
            turn = _twist(
                *(
                    _matrices(each, f"ORG-{bone}")[:, :3, 3]
                    for each in (now, poses)
                    for bone in limb[:3]
                )
            )
            control = wanted[_ik(limb[0])]
            control[:, :3, :3] = turn @ control[:, :3, :3]
            twisted[_ik(limb[0])] = control
        _key_controls(rig, frames, twisted)


def _fk(bone: str) -> str:
    return bone.replace(".", "_fk.")


def _ik(bone: str) -> str:
    return bone.replace(".", "_ik.")


def _twist(*joints: FloatArray) -> FloatArray:
    """(T, 3, 3) turns of limbs about the line between their ends, that take one's middle joint to
    where the other's is. joints: (T, 3) each, of the one and of the other."""
    first, middle, last, other_first, other_middle, _ = joints
    line = unit(last - first)
    one, other = (
        unit(m - f - ((m - f) * line).sum(1, keepdims=True) * line)
        for f, m in ((first, middle), (other_first, other_middle))
    )
    angle = np.arctan2((np.cross(one, other) * line).sum(1), (one * other).sum(1))
    return np.stack([rotation_matrix(each) for each in angle[:, None] * line])


def _key_controls(rig: bpy.types.Object, frames: FloatArray, wanted: dict[str, FloatArray]) -> None:
    """Keys controls at poses (T, 4, 4) in the armature's space; those that follow others last."""
    for control, matrices in wanted.items():
        bone = pose_of(rig).bones[control]
        above = _matrices(sample(rig, frames), present(bone.parent).name)
        _key(rig, bone, frames, _bases(bone.bone, matrices, above))


def _bases(bone: bpy.types.Bone, wanted: FloatArray, above: FloatArray) -> FloatArray:
    """(T, 4, 4) pose bases with which a bone is where wanted, its parent at (T, 4, 4)."""
    parent = present(bone.parent)
    return np.array(
        [
            bone.convert_local_to_pose(
                Matrix(at.tolist()),
                bone.matrix_local,
                parent_matrix=Matrix(there.tolist()),
                parent_matrix_local=parent.matrix_local,
                invert=True,
            )
            for at, there in zip(wanted, above, strict=True)
        ]
    )


def _matrices(poses: Poses, bone: str) -> FloatArray:
    """(T, 4, 4) of a bone."""
    return poses.matrices[:, poses.bones.index(bone)]


def _curves(rig: bpy.types.Object) -> fcurves.CurveHolder:
    holder = fcurves.holder(rig)
    assert holder is not None
    return holder


def _forget(rig: bpy.types.Object, bones: set[str]) -> None:
    holder = _curves(rig)
    for curve in list(holder.fcurves):
        if fcurves.bone_of(curve.data_path) in bones:
            holder.fcurves.remove(curve)


def _key(
    rig: bpy.types.Object, bone: bpy.types.PoseBone, frames: FloatArray, basis: FloatArray
) -> None:
    curves = _curves(rig)
    quaternion = bone.rotation_mode == "QUATERNION"
    path = bone.path_from_id("rotation_quaternion" if quaternion else "rotation_euler")
    values = channels(proper(basis[:, :3, :3]), bone.rotation_mode)
    fcurves.write_channels(curves, path, frames, values, bone.name)
    if not all(bone.lock_location):
        fcurves.write_channels(
            curves, bone.path_from_id("location"), frames, basis[:, :3, 3], bone.name
        )
