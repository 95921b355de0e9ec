"""Armature and action from a motion clip, every file frame on one scene frame."""

from __future__ import annotations

import bpy
import numpy as np

from ..accessors import armature_data, present
from ..armature import fcurves
from ..armature.channels import quaternions
from ..formats.motion_clip import MotionClip, UpAxis, rest_axes, rest_heads, to_z_up

FIRST_FRAME = 1


def build_armature(clip: MotionClip, unit: float, up: UpAxis) -> bpy.types.Object:
    """Make an armature in the scene's collection, and its action; quaternions, linear keys.

    unit: lengths in the scene per unit of the clip. Each bone reaches from its joint's head to its
    tail. The scene's rate and range are the caller's to set.
    """
    data = bpy.data.armatures.new(clip.name)
    armature = bpy.data.objects.new(clip.name, data)
    present(bpy.context.collection).objects.link(armature)
    names = _add_bones(armature, clip, unit, up)
    _add_keys(armature, clip, names, unit, up)
    return armature


def _add_bones(armature: bpy.types.Object, clip: MotionClip, unit: float, up: UpAxis) -> list[str]:
    """Edit bones of the joints; the names that Blender gave them (it shortens long ones)."""
    turn = to_z_up(up)
    heads = unit * rest_heads(clip) @ turn.T
    tails = heads + unit * rest_axes(clip) @ turn.T
    present(bpy.context.view_layer).objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    bones = [armature_data(armature).edit_bones.new(joint.name) for joint in clip.joints]
    for j, (bone, joint) in enumerate(zip(bones, clip.joints, strict=True)):
        bone.head, bone.tail = heads[j], tails[j]
        if joint.parent >= 0:
            bone.parent = bones[joint.parent]
            still = not np.ptp(clip.positions[:, j], axis=0).any()
            bone.use_connect = bool(still and np.allclose(heads[j], tails[joint.parent], atol=1e-7))
    names = [bone.name for bone in bones]
    bpy.ops.object.mode_set(mode="OBJECT")
    return names


def _add_keys(
    armature: bpy.types.Object, clip: MotionClip, names: list[str], unit: float, up: UpAxis
) -> None:
    turn = to_z_up(up)
    curves = fcurves.new_holder(armature, clip.name)
    frames = np.arange(len(clip.positions), dtype=np.float64) + FIRST_FRAME
    for j, (joint, name) in enumerate(zip(clip.joints, names, strict=True)):
        rest = np.array(armature_data(armature).bones[name].matrix_local.to_3x3(), float)
        path = f'pose.bones["{bpy.utils.escape_identifier(name)}"]'
        rotation = turn @ clip.rotations[:, j] @ turn.T
        if np.ptp(rotation, axis=0).any() or not np.allclose(rotation[0], np.eye(3)):
            values = quaternions(rest.T @ rotation @ rest)
            fcurves.write_channels(curves, f"{path}.rotation_quaternion", frames, values, name)
        shift = unit * (clip.positions[:, j] - joint.offset) @ turn.T
        if shift.any():
            fcurves.write_channels(curves, f"{path}.location", frames, shift @ rest, name)
