"""A rig of other proportions: built, read back, and the same as the recording it was built from."""

import bpy
import numpy as np
from hangtime.bridge.armature.read import read_recording
from hangtime.bridge.files.build_armature import build_armature
from hangtime.bridge.formats.motion_clip import from_recording
from hangtime.solver.body.proportions import changed_recording
from hangtime.solver.data.recording import Recording
from hangtime.solver.data.requests import LimbChange
from hangtime.tests.blender.helpers import rigs
from hangtime.tests.helpers.clips import load_recording

LEGS = LimbChange("Short legs", ("LeftUpLeg", "LeftLeg", "RightUpLeg", "RightLeg"), 0.8)


def short_legged() -> Recording:
    recording = load_recording("forward_jump_116cm.bvh").window(150.0, 210.0)
    return changed_recording(recording, (LEGS,))


def test_a_rig_of_those_proportions_is_built() -> None:
    rigs.reset()
    made = short_legged()
    bpy.context.scene.render.fps, bpy.context.scene.render.fps_base = 120, 1.0
    read = read_recording(build_armature(from_recording(made), 1.0, "Z"))
    np.testing.assert_allclose(read.times, made.times, atol=1e-3)
    for b, bone in enumerate(made.bones):
        theirs = read.bones[read.index(bone.name)]
        np.testing.assert_allclose(theirs.head, bone.head, atol=1e-6)
        np.testing.assert_allclose(theirs.tail, bone.tail, atol=1e-6)
        there = read.heads[:, read.index(bone.name)]
        np.testing.assert_allclose(there, made.heads[:, b], atol=2e-5)
        turned = read.rotations[:, read.index(bone.name)] @ theirs.rotation.T
        np.testing.assert_allclose(turned, made.rotations[:, b] @ bone.rotation.T, atol=2e-5)
