"""A rig with the actor's jump in Blender."""

from __future__ import annotations

import bpy
import numpy as np
from mathutils import Vector

from ...bridge.accessors import armature_data, pose_of, present
from ...bridge.armature import fcurves
from ...bridge.armature.channels import channels
from ...solver.arrays import FloatArray
from ..figures.clips import RATE
from .actor import JOINTS, Actor
from .layout import GROUND, Layout, Travel
from .rest import axes, rest_heads, rest_pose

STILL = 1e-6  # m; a bone that moves by less has no keys of its place
PATHS = {"QUATERNION": "rotation_quaternion", "AXIS_ANGLE": "rotation_axis_angle"}


def build(layout: Layout, actor: Actor) -> bpy.types.Object:
    """The rig in an empty scene of its own, at the actor's frames and rate."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    scene = present(bpy.context.scene)
    scene.render.fps, scene.render.fps_base = round(RATE), 1.0
    scene.frame_start, scene.frame_end = int(actor.frames[0]), int(actor.frames[-1])
    armature = bpy.data.objects.new(layout.name, bpy.data.armatures.new(layout.name))
    present(scene.collection).objects.link(armature)
    armature.scale = (layout.unit,) * 3
    _add_bones(armature, layout, actor)
    _add_keys(armature, layout, actor)
    present(bpy.context.view_layer).update()
    return armature


def _add_bones(armature: bpy.types.Object, layout: Layout, actor: Actor) -> None:
    present(bpy.context.view_layer).objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    heads = rest_heads(layout, actor)
    edit = armature_data(armature).edit_bones
    for i, bone in enumerate(layout.bones):
        made = edit.new(bone.name)
        assert made.name == bone.name
        rotation, length = axes(layout, i, heads, actor)
        made.head = Vector(tuple(heads[i] / layout.unit))
        made.tail = Vector(tuple((heads[i] + length * rotation[:, 1]) / layout.unit))
        made.align_roll(Vector(tuple(rotation[:, 2])))
        if bone.parent is not None:
            made.parent = edit[bone.parent]
    bpy.ops.object.mode_set(mode="OBJECT")


def _add_keys(armature: bpy.types.Object, layout: Layout, actor: Actor) -> None:
    carried = _carrier(layout, actor)
    curves = fcurves.new_holder(armature, layout.name)
    if layout.travel is Travel.OBJECT:
        fcurves.write_channels(curves, "location", actor.frames, carried, "Object")
    poses = _poses(armature, layout, actor, carried)
    rests = {b.name: np.array(b.matrix_local) for b in armature_data(armature).bones}
    for bone in layout.bones:
        basis = np.linalg.solve(rests[bone.name], poses[bone.name])
        if bone.parent is not None:
            offset = np.linalg.solve(rests[bone.parent], rests[bone.name])
            basis = np.linalg.solve(poses[bone.parent] @ offset, poses[bone.name])
        posed = pose_of(armature).bones[bone.name]
        posed.rotation_mode = layout.mode  # type: ignore[assignment]
        path = posed.path_from_id(PATHS.get(layout.mode, "rotation_euler"))
        values = channels(basis[:, :3, :3], layout.mode)
        fcurves.write_channels(curves, path, actor.frames, values, bone.name)
        if np.abs(basis[:, :3, 3]).max() * layout.unit > STILL * 10:
            path = posed.path_from_id("location")
            fcurves.write_channels(curves, path, actor.frames, basis[:, :3, 3], bone.name)


def _carrier(layout: Layout, actor: Actor) -> FloatArray:
    """(T, 3) m, how far the root bone or the object goes over the floor."""
    if layout.travel is Travel.HIPS:
        return np.zeros((len(actor.frames), 3))
    return np.asarray(actor.heads[:, 0] * [1.0, 1.0, 0.0])


def _poses(
    armature: bpy.types.Object, layout: Layout, actor: Actor, carried: FloatArray
) -> dict[str, FloatArray]:
    """(T, 4, 4) of each bone in the armature's space and units."""
    centres, turned = rest_pose(layout, actor)
    shift = carried if layout.travel is Travel.OBJECT else np.zeros_like(carried)
    poses = {}
    for bone, head in zip(layout.bones, rest_heads(layout, actor), strict=True):
        rest = np.array(armature_data(armature).bones[bone.name].matrix_local)
        pose = np.tile(np.eye(4), (len(actor.frames), 1, 1))
        if bone.joint == GROUND:
            pose[:, :3, :3] = rest[:3, :3]
            moved = layout.travel is Travel.ROOT and bone.parent is None
            place = head + (carried if moved else np.zeros_like(carried))
        else:
            j = JOINTS.index(bone.joint)
            turns = actor.turns[:, j] @ turned[j].T
            pose[:, :3, :3] = turns @ rest[:3, :3]
            place = actor.heads[:, j] + turns @ (head - centres[j])
        pose[:, :3, 3] = (place - shift) / layout.unit
        poses[bone.name] = pose
    return poses
