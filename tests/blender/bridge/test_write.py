"""What is written into Blender's armatures and actions, in the bpy module."""

from __future__ import annotations

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature import fcurves
from hangtime.bridge.armature.channels import EULER_ORDERS, proper
from hangtime.bridge.armature.read import read_recording
from hangtime.bridge.armature.write import write_action
from hangtime.tests.blender.helpers import rigs
from hangtime.tests.blender.helpers.actions import (
    altered,
    animated_rig,
    assert_follows,
    curves_of,
    frames_of,
    place_object,
    snapshot,
)

MODES = ("QUATERNION", "AXIS_ANGLE", *EULER_ORDERS)


@pytest.fixture(autouse=True)
def _empty_scene() -> None:
    rigs.reset()


@pytest.mark.parametrize("mode", MODES)
def test_every_rotation_mode_follows_the_track_between_frames_too(mode: str) -> None:
    armature = animated_rig(mode)
    track = altered(read_recording(armature))
    write_action(armature, track, name="Adapted")
    assert_follows(armature, track)
    for t in range(len(track.frames) - 1):
        between = proper(track.rotations[t] + track.rotations[t + 1])
        for b, bone in enumerate(track.bones):
            world = rigs.world_of(armature, bone, track.frames[t] + 0.5).to_3x3()
            np.testing.assert_allclose(world, between[b], atol=0.06)
    for bone in rigs.MOVING:
        path = armature.pose.bones[bone].path_from_id(rigs.rotation_path(armature.pose.bones[bone]))
        curves = [c for c in curves_of(armature) if c.data_path == path]
        assert len(curves) == (3 if mode in EULER_ORDERS else 4)
        for curve in curves:
            np.testing.assert_array_equal(fcurves.keys(curve)[:, 0], track.frames)
            assert {k.interpolation for k in curve.keyframe_points} == {"LINEAR"}


def test_quaternions_never_change_sign() -> None:
    armature = animated_rig()
    write_action(armature, altered(read_recording(armature)), name="Adapted")
    for bone in rigs.MOVING:
        path = armature.pose.bones[bone].path_from_id("rotation_quaternion")
        values = np.array(
            [fcurves.keys(c)[:, 1] for c in curves_of(armature) if c.data_path == path]
        )
        assert values.shape == (4, 24)
        assert (np.einsum("it,it->t", values[:, 1:], values[:, :-1]) > 0.9).all()


def test_objects_may_be_turned_scaled_parented_and_animated() -> None:
    armature = animated_rig("ZXY")
    place_object(armature)
    bpy.context.scene.unit_settings.scale_length = 0.01
    armature.keyframe_insert("location", frame=1)
    armature.location = (5.0, 1.0, 1.0)
    armature.keyframe_insert("location", frame=20)
    before = snapshot(armature.animation_data.action, armature)
    track = altered(read_recording(armature))
    action = write_action(armature, track, name="Adapted")
    assert_follows(armature, track)
    after = snapshot(action, armature)
    assert all(after["location", i] == before["location", i] for i in range(3))


@pytest.mark.parametrize("connected", [False, True])
def test_a_root_above_the_pelvis_keeps_its_keys_unless_it_carries_the_pelvis(
    connected: bool,
) -> None:
    armature = animated_rig(specs=rigs.with_root(connected=connected))
    before = snapshot(armature.animation_data.action, armature)
    track = altered(read_recording(armature))
    action = write_action(armature, track, name="Adapted")
    assert_follows(armature, track)
    after = snapshot(action, armature)
    kept = {c for c in before if c[0] == 'pose.bones["root"].rotation_quaternion'}
    location = {c for c in before if c[0] == 'pose.bones["root"].location'}
    assert len(kept) == 4
    assert all(after[c] == before[c] for c in kept)
    assert len(location) == 3
    assert all((after[c] == before[c]) != connected for c in location)


@pytest.mark.parametrize(
    ("bone", "prop", "value"),
    [
        ("spine", "use_inherit_rotation", False),
        ("thigh", "use_inherit_rotation", False),
        ("hips", "use_inherit_rotation", False),
        ("hips", "use_local_location", False),
        ("shin", "inherit_scale", "FULL"),
        ("shin", "inherit_scale", "NONE"),
        ("shin", "inherit_scale", "AVERAGE"),
        ("shin", "inherit_scale", "ALIGNED"),
        ("shin", "inherit_scale", "FIX_SHEAR"),
        ("shin", "inherit_scale", "NONE_LEGACY"),
    ],
)
def test_bones_that_inherit_in_part_from_stretched_ones(
    bone: str, prop: str, value: bool | str
) -> None:
    armature = rigs.make_armature(rigs.with_root())
    setattr(armature.data.bones[bone], prop, value)
    rigs.animate(armature)
    thigh = armature.pose.bones["thigh"]
    thigh.scale = (0.9, 1.3, 1.0)
    thigh.keyframe_insert("scale", frame=1)
    track = altered(read_recording(armature))
    write_action(armature, track, name="Adapted")
    assert_follows(armature, track)
    np.testing.assert_allclose(thigh.scale, (0.9, 1.3, 1.0))


def test_riding_bones_keep_their_keys_and_their_pose_on_their_parent() -> None:
    armature = animated_rig("YZX")
    armature.pose.bones["finger"]["strength"] = 0.5
    armature.pose.bones["finger"].keyframe_insert('["strength"]', frame=2)
    before = snapshot(armature.animation_data.action, armature)
    recorded = read_recording(armature)
    track = altered(recorded)
    action = write_action(armature, track, name="Adapted")
    read = assert_follows(armature, track)
    after = snapshot(action, armature)
    riding = [c for c in before if fcurves.bone_of(c[0]) in rigs.RIDING]
    assert len(riding) == 7
    assert all(after[c] == before[c] for c in riding)
    for bone, parent in (("finger", "head"), ("twist", "spine")):
        b, p = recorded.index(bone), recorded.index(parent)
        was = recorded.rotations[:, p].swapaxes(1, 2) @ recorded.rotations[:, b]
        now = read.rotations[:, p].swapaxes(1, 2) @ read.rotations[:, b]
        np.testing.assert_allclose(now, was, atol=1e-5)


def test_channels_of_other_rotation_modes_go() -> None:
    armature = animated_rig()
    for bone in ("shin", "finger"):
        armature.pose.bones[bone].keyframe_insert("rotation_euler", frame=3)
    write_action(armature, altered(read_recording(armature)), name="Adapted")
    paths = {c.data_path for c in curves_of(armature)}
    assert 'pose.bones["shin"].rotation_euler' not in paths
    assert 'pose.bones["finger"].rotation_euler' in paths


def test_modifiers_and_muting_of_replaced_curves_go() -> None:
    armature = animated_rig("XYZ")
    shin = [c for c in curves_of(armature) if fcurves.bone_of(c.data_path) == "shin"]
    shin[0].modifiers.new("NOISE")
    shin[1].mute = True
    track = altered(read_recording(armature))
    write_action(armature, track, name="Adapted")
    assert_follows(armature, track)


def test_bones_without_keys_get_them() -> None:
    armature = rigs.make_armature()
    armature.pose.bones["finger"].keyframe_insert("rotation_quaternion", frame=1)
    armature.pose.bones["finger"].keyframe_insert("rotation_quaternion", frame=9)
    track = altered(read_recording(armature))
    write_action(armature, track, name="Adapted")
    assert_follows(armature, track)
    new = [c for c in curves_of(armature) if fcurves.bone_of(c.data_path) != "finger"]
    assert len(new) == 4 * len(rigs.MOVING) + 3
    assert all(curve.group.name == fcurves.bone_of(curve.data_path) for curve in new)


def test_the_recording_is_left_alone() -> None:
    armature = animated_rig()
    recorded = armature.animation_data.action
    before = snapshot(recorded, armature)
    bpy.context.scene.frame_set(9)
    action = write_action(armature, altered(read_recording(armature)), name="Adapted")
    assert armature.animation_data.action == action
    assert action != recorded
    assert action.name == "Adapted"
    assert recorded.use_fake_user
    assert not action.use_fake_user
    assert snapshot(recorded, armature) == before
    assert snapshot(action, armature) != before
    assert bpy.context.scene.frame_current == 9


def test_a_window_of_the_clip_loses_the_keys_outside_but_no_pose() -> None:
    armature = animated_rig()
    finger = armature.pose.bones["finger"]
    for frame, x in ((1, 0.0), (8, 1.0), (12, -1.0), (15, 0.0), (24, 2.0)):
        finger.location.x = x
        finger.keyframe_insert("location", frame=frame)
    whole = read_recording(armature)
    track = altered(whole.window(10, 20))
    write_action(armature, track, name="Adapted")
    read = assert_follows(armature, track)
    for curve in curves_of(armature):
        frames = fcurves.keys(curve)[:, 0]
        assert frames.min() == 10.0
        assert frames.max() == 20.0
    assert {12.0, 15.0} < frames_of(armature, 'pose.bones["finger"].location')
    finger, head = read.index("finger"), read.index("head")
    was = whole.window(10, 20)
    turn = read.rotations[:, head] @ was.rotations[:, head].swapaxes(1, 2)
    arm = (turn @ (was.heads[:, finger] - was.heads[:, head])[..., None])[..., 0]
    np.testing.assert_allclose(read.heads[:, finger] - read.heads[:, head], arm, atol=1e-5)


def test_cropping_keeps_curves_that_are_keyed_on_one_side_only_or_cycle() -> None:
    armature = animated_rig()
    finger = armature.pose.bones["finger"]
    finger.location.x = 0.7
    finger.keyframe_insert("location", index=0, frame=2)
    finger.keyframe_insert("scale", index=0, frame=1)
    finger.scale.x = 2.0
    finger.keyframe_insert("scale", index=0, frame=4)
    cyclic = next(c for c in curves_of(armature) if c.data_path.endswith(".scale"))
    cyclic.modifiers.new("CYCLES")
    write_action(armature, altered(read_recording(armature, first=10, last=20)), name="Adapted")
    by_path = {c.data_path: c for c in curves_of(armature)}
    assert by_path['pose.bones["finger"].location'].evaluate(15) == pytest.approx(0.7)
    assert frames_of(armature, 'pose.bones["finger"].scale') == {1.0, 4.0}
