"""A rig as people make them by hand: bones that are posed themselves, legs by feet and poles."""

from __future__ import annotations

import bpy
import numpy as np

LENGTHS = {  # bone: head, tail, parent; m; a left side is mirrored
    "hips": ((0.0, 0.0, 1.0), (0.0, 0.0, 1.12), None),
    "spine": ((0.0, 0.0, 1.12), (0.0, 0.0, 1.27), "hips"),
    "spine.001": ((0.0, 0.0, 1.27), (0.0, 0.0, 1.42), "spine"),
    "chest": ((0.0, 0.0, 1.42), (0.0, 0.0, 1.5), "spine.001"),
    "neck": ((0.0, 0.0, 1.5), (0.0, 0.0, 1.6), "chest"),
    "head": ((0.0, 0.0, 1.6), (0.0, 0.0, 1.8), "neck"),
    "thigh.L": ((0.1, 0.0, 1.0), (0.1, -0.02, 0.53), "hips"),
    "shin.L": ((0.1, -0.02, 0.53), (0.1, 0.0, 0.09), "thigh.L"),
    "foot.L": ((0.1, 0.0, 0.09), (0.1, -0.15, 0.02), "shin.L"),
    "toe.L": ((0.1, -0.15, 0.02), (0.1, -0.22, 0.02), "foot.L"),
    "upper_arm.L": ((0.2, 0.0, 1.48), (0.47, 0.01, 1.48), "chest"),
    "forearm.L": ((0.47, 0.01, 1.48), (0.72, 0.0, 1.48), "upper_arm.L"),
    "hand.L": ((0.72, 0.0, 1.48), (0.88, 0.0, 1.48), "forearm.L"),
    "stand.L": ((0.1, 0.0, 0.09), (0.1, -0.15, 0.02), None),
    "knee_pole.L": ((0.1, -0.6, 0.53), (0.1, -0.7, 0.53), None),
}


def ik_rig() -> bpy.types.Object:
    """The rig at rest, the scene's active object."""
    rig = bpy.data.objects.new("Handmade", bpy.data.armatures.new("Handmade"))
    bpy.context.scene.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    bones = rig.data.edit_bones
    for name, (head, tail, parent) in LENGTHS.items():
        for side, sign in (("L", 1.0), ("R", -1.0)) if name.endswith(".L") else (("", 1.0),):
            bone = bones.new(_sided(name, side))
            bone.head, bone.tail = (np.array(end) * [sign, 1.0, 1.0] for end in (head, tail))
            bone.parent = bones[_sided(parent, side)] if parent else None
    bpy.ops.object.mode_set(mode="OBJECT")
    for side in "LR":
        _legs_in_chain(rig, side)
    return rig


def _sided(name: str, side: str) -> str:
    return f"{name[:-1]}{side}" if side and name.endswith(".L") else name


def _legs_in_chain(rig: bpy.types.Object, side: str) -> None:
    chain = rig.pose.bones[f"shin.{side}"].constraints.new("IK")
    chain.target = chain.pole_target = rig
    chain.subtarget, chain.pole_subtarget = f"stand.{side}", f"knee_pole.{side}"
    chain.chain_count, chain.pole_angle, chain.use_stretch = 2, -np.pi / 2.0, False
    turned = rig.pose.bones[f"foot.{side}"].constraints.new("COPY_ROTATION")
    turned.target, turned.subtarget = rig, f"stand.{side}"
