"""Rigify's generated human with the actor's jump on its controls."""

from __future__ import annotations

import addon_utils
import bpy
import numpy as np

from ...bridge.accessors import armature_data, current_scene, pose_of, present
from ...bridge.armature import fcurves
from ...bridge.armature.channels import channels, proper
from ...bridge.armature.incremental import complete
from ...bridge.armature.poses import sample
from ...bridge.armature.read import rest_bones
from ...bridge.controls.control_rig import ControlPoses, ControlRig, control_poses, found_controls
from ...bridge.controls.responses import Freedom
from ...solver.arrays import FloatArray
from ...solver.body.anatomy import Part, Segment, Side, map_anatomy
from ...solver.data.recording import PoseTrack
from ...solver.numerics.rotations import axis_rotation
from ..figures.clips import RATE
from .actor import JOINTS, Actor

SWITCH = "IK_FK"  # 0 is inverse kinematics


def generated_human(actor: Actor, arms: float, legs: float) -> bpy.types.Object:
    """The generated rig in an empty scene of its own, with the actor's legs' length.

    arms, legs: 0 for inverse kinematics, 1 for forward.
    """
    bpy.ops.wm.read_factory_settings(use_empty=True)
    addon_utils.enable("rigify", default_set=True)
    scene = current_scene()
    scene.render.fps, scene.render.fps_base = round(RATE), 1.0
    scene.frame_start, scene.frame_end = int(actor.frames[0]), int(actor.frames[-1])
    bpy.ops.object.armature_basic_human_metarig_add()  # type: ignore[attr-defined]  # Rigify's
    meta = present(bpy.context.object)
    bones = armature_data(meta).bones
    leg = bones["thigh.L"].length + bones["shin.L"].length
    meta.scale = (_leg(actor) / leg,) * 3
    bpy.ops.object.transform_apply(location=False, rotation=False, scale=True)
    bpy.ops.pose.rigify_generate()  # type: ignore[attr-defined]
    rig = present(bpy.context.object)
    bpy.data.objects.remove(meta)
    for bone in pose_of(rig).bones:
        if bone.get(SWITCH) is not None:
            bone[SWITCH] = legs if "thigh" in bone.name else arms
    rig.update_tag()
    present(bpy.context.view_layer).update()
    return rig


def _leg(actor: Actor) -> float:
    thigh, shank, foot = (actor.at(f"{name}.l") for name in ("thigh", "shank", "foot"))
    return float(np.linalg.norm(shank - thigh) + np.linalg.norm(foot - shank))


def carried(rig: bpy.types.Object, actor: Actor) -> PoseTrack:
    """The actor's turns for the rig's own bodies."""
    still = sample(rig, actor.frames[:1])
    bones = rest_bones(rig, still)
    segments = map_anatomy(bones)
    spine = [s for s in segments if s.part is Part.SPINE]
    joints = [JOINTS.index(_joint(segment, spine)) for segment in segments]
    lowered = actor.lowered()
    rest = np.stack([bones[s.bone].rotation for s in segments])
    turns = actor.turns[:, joints] @ np.swapaxes(lowered[joints], 1, 2)
    pelvis = bones[segments[0].bone].head
    ankle = bones[next(s.bone for s in segments if s.part is Part.FOOT)].head
    higher = (pelvis - ankle)[2] - (actor.at("pelvis") - actor.at("foot.l"))[2]
    turned = _facing(actor)
    return PoseTrack(
        actor.frames,
        tuple(bones[s.bone].name for s in segments),
        turned @ turns @ turned.T @ rest,
        (actor.heads[:, 0] + np.array([0.0, 0.0, higher])) @ turned.T,
    )


def _facing(actor: Actor) -> FloatArray:
    """(3, 3) turn from where the actor's toes point at rest to where the rig's do: -Y."""
    ahead = actor.end("foot.l") - actor.at("foot.l")
    turned: FloatArray = axis_rotation(2, -np.pi / 2.0 - np.arctan2(ahead[1], ahead[0]))
    return turned


def _joint(segment: Segment, spine: list[Segment]) -> str:
    """The actor's joint at which a body begins."""
    if segment.part is Part.SPINE:
        return f"spine{spine.index(segment) + 1}"
    name = segment.part.value.replace(" ", "_")
    return name if segment.side is Side.MIDDLE else f"{name}.{segment.side.value[0]}"


def perform(rig: bpy.types.Object, actor: Actor) -> tuple[ControlRig, ControlPoses]:
    """Key the controls such that the rig performs the actor's jump."""
    track = carried(rig, actor)
    found = complete(found_controls(rig, track.bones, track.frames))
    posed = complete(control_poses(found, sample(rig, track.frames), track))
    curves = fcurves.new_holder(rig, "jump")
    for name, freedoms in found.used.items():
        _key(rig, curves, name, freedoms, track.frames, posed.bases[name])
    return found, posed


def _key(
    rig: bpy.types.Object,
    curves: fcurves.CurveHolder,
    name: str,
    freedoms: set[Freedom],
    frames: FloatArray,
    bases: FloatArray,
) -> None:
    bone = pose_of(rig).bones[name]
    if Freedom.TURN in freedoms:
        quaternion = bone.rotation_mode == "QUATERNION"
        path = bone.path_from_id("rotation_quaternion" if quaternion else "rotation_euler")
        values = channels(proper(bases[:, :3, :3]), bone.rotation_mode)
        fcurves.write_channels(curves, path, frames, values, name)
    if Freedom.SHIFT in freedoms:
        path = bone.path_from_id("location")
        fcurves.write_channels(curves, path, frames, bases[:, :3, 3], name)
    if Freedom.SIZE in freedoms:
        path = bone.path_from_id("scale")
        values = np.linalg.norm(bases[:, :3, :3], axis=1)
        fcurves.write_channels(curves, path, frames, values, name)
