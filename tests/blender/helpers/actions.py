"""Armatures with keys, and what tests ask of their actions."""

from __future__ import annotations

import math

import bpy
import numpy as np
from hangtime.bridge.armature import fcurves
from hangtime.bridge.armature.read import read_recording
from hangtime.solver.data.recording import PoseTrack, Recording
from hangtime.tests.blender.helpers import rigs

SHIFT = np.array([0.3, -0.1, 0.2])


def altered(recording: Recording, bones: tuple[str, ...] = rigs.MOVING) -> PoseTrack:
    """The recording's bones, each swung by up to a radian in the world; the pelvis shifted."""
    rng = np.random.default_rng(5)
    turned = []
    for bone in bones:
        amplitudes = rng.uniform(-0.5, 0.5, (2, 3))
        swings = [rigs.swing(amplitudes, f).to_matrix() for f in recording.frames]
        turned.append(np.array(swings) @ recording.rotations[:, recording.index(bone)])
    head = recording.heads[:, recording.index(bones[0])]
    shift = SHIFT * np.sin(recording.frames / 10.0)[:, None]
    return PoseTrack(recording.frames, bones, np.stack(turned, axis=1), head + shift)


def assert_follows(armature: bpy.types.Object, track: PoseTrack) -> Recording:
    """The armature's evaluated pose is the track's; returns it."""
    read = read_recording(armature)
    moving = [read.index(bone) for bone in track.bones]
    np.testing.assert_array_equal(read.frames, track.frames)
    np.testing.assert_allclose(read.rotations[:, moving], track.rotations, atol=1e-5)
    np.testing.assert_allclose(read.heads[:, moving[0]], track.root_head, atol=1e-5)
    return read


def snapshot(action: bpy.types.Action, armature: bpy.types.Object) -> dict[tuple[str, int], bytes]:
    """Every key and handle of an action, by channel, while it is the armature's."""
    return {
        (c.data_path, c.array_index): b"".join(
            np.array([*k.co, *k.handle_left, *k.handle_right], np.float32).tobytes()
            + k.interpolation.encode()
            for k in c.keyframe_points
        )
        for c in curves_of(armature, action)
    }


def curves_of(
    armature: bpy.types.Object, action: bpy.types.Action | None = None
) -> list[bpy.types.FCurve]:
    """The curves that animate the armature, or would under another action."""
    data, slot = armature.animation_data, fcurves.slot_identifier(armature)
    was = data.action
    if action is not None:
        fcurves.assign(armature, action, slot)
    holder = fcurves.holder(armature)
    if action is not None:
        fcurves.assign(armature, was, slot)
    assert holder is not None
    return list(holder.fcurves)


def frames_of(armature: bpy.types.Object, path: str) -> set[float]:
    return {
        float(f) for c in curves_of(armature) if c.data_path == path for f in fcurves.keys(c)[:, 0]
    }


def animated_rig(mode: str = "QUATERNION", specs: list[rigs.BoneSpec] | None = None):
    armature = rigs.make_armature(specs or rigs.BODY)
    rigs.animate(armature, mode)
    return armature


def place_object(armature: bpy.types.Object) -> None:
    """Turn, move and scale the object; hang it from a scaled parent."""
    parent = bpy.data.objects.new("Parent", None)
    bpy.context.scene.collection.objects.link(parent)
    parent.scale = (0.5, 0.5, 0.5)
    parent.rotation_euler = (0.1, 0.2, 0.9)
    armature.parent = parent
    armature.location, armature.rotation_euler = (1.0, -2.0, 0.5), (math.pi / 2, 0.0, 0.4)
    armature.scale = (3.0, 3.0, 3.0)
