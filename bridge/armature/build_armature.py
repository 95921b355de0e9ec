"""A motion clip as an armature with an action, every file frame on one scene frame."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..formats.skeleton import MotionClip, UpAxis, rest_axes, rest_heads, to_z_up
from .channels import quaternions

if TYPE_CHECKING:
    import bpy

FIRST_FRAME = 1


def build_armature(clip: MotionClip, unit: float, up: UpAxis) -> bpy.types.Object:
    """A new armature in the scene's collection, and its action; quaternions, linear keys.

    unit: lengths in the scene per unit of the clip. Each bone reaches from its joint's head to its
    tail. The scene's rate and range are the caller's to set.
    """
    import bpy

    data = bpy.data.armatures.new(clip.name)
    armature = bpy.data.objects.new(clip.name, data)
    bpy.context.collection.objects.link(armature)
    names = _add_bones(armature, clip, unit, up)
    _add_keys(armature, clip, names, unit, up)
    return armature


def _add_bones(armature: bpy.types.Object, clip: MotionClip, unit: float, up: UpAxis) -> list[str]:
    """Names that Blender gave the joints' bones (it shortens long ones)."""
    import bpy

    turn = to_z_up(up)
    heads = unit * rest_heads(clip) @ turn.T
    tails = heads + unit * rest_axes(clip) @ turn.T
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    bones = [armature.data.edit_bones.new(joint.name) for joint in clip.joints]
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
    from .fcurves import write_channel

    turn = to_z_up(up)
    curves = _new_action(armature, clip.name)
    frames = FIRST_FRAME + np.arange(len(clip.positions), dtype=float)
    for j, (joint, name) in enumerate(zip(clip.joints, names, strict=True)):
        rest = np.array(armature.data.bones[name].matrix_local.to_3x3())
        path = f'pose.bones["{_escaped(name)}"]'
        rotation = turn @ clip.rotations[:, j] @ turn.T
        if np.ptp(rotation, axis=0).any() or not np.allclose(rotation[0], np.eye(3)):
            values = quaternions(rest.T @ rotation @ rest)
            for index in range(4):
                column = values[:, index]
                write_channel(curves, f"{path}.rotation_quaternion", index, frames, column, name)
        shift = unit * (clip.positions[:, j] - joint.offset) @ turn.T
        if shift.any():
            for index, column in enumerate((shift @ rest).T):
                write_channel(curves, f"{path}.location", index, frames, column, name)


def _escaped(name: str) -> str:
    import bpy

    return bpy.utils.escape_identifier(name)


def _new_action(
    armature: bpy.types.Object, name: str
) -> bpy.types.Action | bpy.types.ActionChannelbag:
    """What holds the curves of a new action that animates the armature."""
    import bpy

    data = armature.animation_data_create()
    data.action = action = bpy.data.actions.new(name)
    if not hasattr(action, "slots"):
        return action
    data.action_slot = slot = action.slots.new(armature.id_type, armature.name)
    strip = action.layers.new("Layer").strips.new(type="KEYFRAME")
    return strip.channelbag(slot, ensure=True)
