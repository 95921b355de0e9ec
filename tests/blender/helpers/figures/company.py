"""A figure that travels under a root bone, with helper bones on it."""

from __future__ import annotations

import bpy
import numpy as np
from hangtime.bridge.armature.poses import Poses, sample
from hangtime.tests.blender.helpers import rigs
from mathutils import Matrix

LENGTH = 60
FRAMES = np.arange(1.0, LENGTH + 1.0)
HELPERS = (
    rigs.BoneSpec("ik_root", "root", (0.0, 0.0, 0.0), (0.0, 0.2, 0.0)),
    rigs.BoneSpec("ik_foot", "ik_root", (0.12, 0.02, 0.1), (0.14, -0.15, 0.02), 0.8),
    rigs.BoneSpec("ik_gun", "ik_root", (0.1, 0.0, 1.0), (0.1, 0.3, 1.0)),
    rigs.BoneSpec("ik_head", "ik_gun", (0.0, 0.05, 1.5), (0.0, 0.05, 1.7)),
    rigs.BoneSpec("prop", "root", (0.5, 0.0, 0.0), (0.5, 0.0, 0.3)),
)
ON = {"ik_foot": "foot", "ik_gun": "thigh", "ik_head": "head"}


def along(frame: float) -> float:
    """m, from where to where the figure goes, at a frame."""
    return -1.5 * float(np.sin(0.5 * np.pi * np.clip((frame - 10.0) / 40.0, 0.0, 1.0)) ** 2)


def take(mode: str = "QUATERNION", *, root: str = "along", baked: bool = True) -> bpy.types.Object:
    """A figure that travels, under a root bone. root: "along" with it, "still", or on its own
    "other" way. baked: whether helper bones are on it."""
    rigs.reset()
    armature = rigs.make_armature([*rigs.with_root(), *HELPERS])
    rigs.animate(armature, mode, frames=range(1, LENGTH + 1))
    bones = armature.pose.bones
    for frame in range(1, LENGTH + 1):
        bpy.context.scene.frame_set(frame)
        ways = {"along": (0.0, along(frame), 0.0), "other": (along(frame), 0.0, 0.0)}
        put(bones["root"], Matrix.Translation(ways.get(root, (0.0, 0.0, 0.0))), frame)
        sways = Matrix.Translation((0.05 * np.sin(0.3 * frame), along(frame), 0.04))
        swings = rigs.swing(np.full((2, 3), 0.2), frame).to_matrix().to_4x4()
        hips = Matrix.Translation(bones["hips"].bone.head_local)
        put(bones["hips"], sways @ hips @ swings @ hips.inverted(), frame)
        put(bones["prop"], Matrix.Translation((0.1 * frame, 0.0, 0.0)), frame)
    if baked:
        bake(armature)
    return armature


def put(bone: bpy.types.PoseBone, moved: Matrix, frame: int) -> None:
    """Key a bone's place at a frame: where it is at rest, moved in the armature's space."""
    bone.matrix = moved @ bone.bone.matrix_local
    bone.keyframe_insert("location", frame=frame)
    bone.keyframe_insert(rigs.rotation_path(bone), frame=frame)
    bpy.context.scene.frame_set(frame)


def bake(armature: bpy.types.Object) -> None:
    """Key helper bones where they stay on the body."""
    for name, body in ON.items():
        helper, shown = armature.pose.bones[name], at(sample(armature, FRAMES), body)
        rest = armature.data.bones
        beside = rest[body].matrix_local.inverted() @ rest[name].matrix_local
        for frame, matrix in zip(FRAMES.astype(int).tolist(), shown, strict=True):
            bpy.context.scene.frame_set(frame)
            helper.matrix = Matrix(matrix.tolist()) @ beside
            helper.keyframe_insert("location", frame=frame)
            helper.keyframe_insert(rigs.rotation_path(helper), frame=frame)


def at(poses: Poses, bone: str) -> np.ndarray:
    """(T, 4, 4) of a bone in the world."""
    return poses.object_to_world @ poses.matrices[:, poses.bones.index(bone)]


def beside(poses: Poses, bone: str, body: str) -> np.ndarray:
    """(T, 4, 4) of a bone in the axes of another."""
    return np.linalg.inv(at(poses, body)) @ at(poses, bone)
