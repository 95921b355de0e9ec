"""Blender's armatures and actions against Recording and PoseTrack, in the bpy module."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature import fcurves
from hangtime.bridge.armature.channels import EULER_ORDERS, proper
from hangtime.bridge.armature.read import read_recording
from hangtime.bridge.armature.write import side_by_side, write_action
from hangtime.bridge.files.export import export_fbx, reimport_fbx
from hangtime.devtools.recordings import JUMP, find
from hangtime.solver.data.faults import (
    BadScale,
    NoAction,
    NoArmature,
    NoBones,
    NonFiniteKey,
    OutputNotWritable,
)
from hangtime.solver.data.recording import PoseTrack, Recording
from hangtime.tests.blender.helpers import rigs

MODES = ("QUATERNION", "AXIS_ANGLE", *EULER_ORDERS)

SHIFT = np.array([0.3, -0.1, 0.2])


@pytest.fixture(autouse=True)
def _empty_scene() -> None:
    rigs.reset()


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


# --- reading --------------------------------------------------------------------------------


def place_object(armature: bpy.types.Object) -> None:
    """Turn, move and scale the object; hang it from a scaled parent."""
    parent = bpy.data.objects.new("Parent", None)
    bpy.context.scene.collection.objects.link(parent)
    parent.scale = (0.5, 0.5, 0.5)
    parent.rotation_euler = (0.1, 0.2, 0.9)
    armature.parent = parent
    armature.location, armature.rotation_euler = (1.0, -2.0, 0.5), (math.pi / 2, 0.0, 0.4)
    armature.scale = (3.0, 3.0, 3.0)


def test_reads_world_poses_in_metres_and_seconds() -> None:
    armature = animated_rig("XYZ")
    place_object(armature)
    scene = bpy.context.scene
    scene.unit_settings.scale_length = 0.01
    scene.render.fps, scene.render.fps_base = 30, 1.001
    recording = read_recording(armature, first=3.5, last=9.0)
    np.testing.assert_array_equal(recording.frames, [4, 5, 6, 7, 8, 9])
    np.testing.assert_allclose(recording.times, np.arange(6) * 1.001 / 30.0)
    for t, frame in enumerate(recording.frames):
        for b, bone in enumerate(recording.bones):
            world = rigs.world_of(armature, bone.name, frame)
            np.testing.assert_allclose(recording.heads[t, b], world.translation * 0.01, atol=1e-8)
            turn = world.to_quaternion().to_matrix()
            np.testing.assert_allclose(recording.rotations[t, b], turn, atol=5e-6)


def test_reads_the_rest_skeleton_parents_first() -> None:
    armature = animated_rig()
    place_object(armature)
    recording = read_recording(armature)
    assert all(bone.parent < b for b, bone in enumerate(recording.bones))
    for bone in recording.bones:
        rest = armature.data.bones[bone.name]
        parent = recording.bones[bone.parent].name if bone.parent >= 0 else None
        assert parent == (rest.parent.name if rest.parent else None)
        np.testing.assert_allclose(bone.head, armature.matrix_world @ rest.head_local, atol=1e-6)
        np.testing.assert_allclose(bone.tail, armature.matrix_world @ rest.tail_local, atol=1e-6)
        along = (bone.tail - bone.head) / np.linalg.norm(bone.tail - bone.head)
        np.testing.assert_allclose(bone.rotation[:, 1], along, atol=1e-5)
        np.testing.assert_allclose(np.linalg.det(bone.rotation), 1.0)


def test_reads_what_constraints_make_of_the_keys() -> None:
    armature = animated_rig()
    free = read_recording(armature)
    constraint = armature.pose.bones["head"].constraints.new("COPY_ROTATION")
    constraint.target, constraint.subtarget = armature, "hips"
    held = read_recording(armature)
    np.testing.assert_allclose(
        held.rotations[:, held.index("head")], free.rotations[:, free.index("hips")], atol=1e-5
    )


def test_reads_the_hidden_and_the_resting_alike_and_leaves_the_scene() -> None:
    armature = animated_rig()
    shown = read_recording(armature)
    collection = bpy.data.collections.new("Excluded")
    bpy.context.scene.collection.children.link(collection)
    collection.objects.link(armature)
    bpy.context.scene.collection.objects.unlink(armature)
    bpy.context.view_layer.layer_collection.children[0].exclude = True
    armature.hide_viewport = True
    armature.data.pose_position = "REST"
    bpy.context.scene.frame_set(7, subframe=0.25)
    hidden = read_recording(armature)
    np.testing.assert_array_equal(hidden.heads, shown.heads)
    np.testing.assert_array_equal(hidden.rotations, shown.rotations)
    assert (bpy.context.scene.frame_current, bpy.context.scene.frame_subframe) == (7, 0.25)
    assert armature.hide_viewport
    assert armature.data.pose_position == "REST"
    assert list(armature.users_collection) == [collection]


def test_reads_a_single_frame() -> None:
    armature = rigs.make_armature()
    armature.pose.bones["hips"].keyframe_insert("rotation_quaternion", frame=5)
    recording = read_recording(armature)
    np.testing.assert_array_equal(recording.frames, [5.0])
    np.testing.assert_array_equal(recording.times, [0.0])


def test_the_manual_frame_range_of_an_action_counts() -> None:
    armature = animated_rig()
    action = armature.animation_data.action
    action.use_frame_range = True
    action.frame_start, action.frame_end = 5.0, 8.0
    np.testing.assert_array_equal(read_recording(armature).frames, [5, 6, 7, 8])


def test_a_stated_range_may_be_read_with_what_is_around_it() -> None:
    """At 24 frames a second; never beyond the action, nor around all of it."""
    armature = animated_rig()
    keyed = read_recording(armature).frames
    around = read_recording(armature, first=15.0, last=16.0, beyond=0.25).frames
    np.testing.assert_array_equal(around, np.arange(9.0, 23.0))
    around = read_recording(armature, first=4.0, last=keyed[-1] - 3.0, beyond=0.5).frames
    np.testing.assert_array_equal(around, keyed)
    action = armature.animation_data.action
    action.use_frame_range = True
    action.frame_start, action.frame_end = 5.0, 18.0
    around = read_recording(armature, first=12.0, last=16.0, beyond=0.5).frames
    np.testing.assert_array_equal(around, np.arange(5.0, 19.0))
    around = read_recording(armature, beyond=0.5).frames
    np.testing.assert_array_equal(around, np.arange(5.0, 19.0))


def test_nothing_or_another_kind_of_object_is_no_armature() -> None:
    with pytest.raises(NoArmature) as nothing:
        read_recording(None)
    assert nothing.value.object_name is None
    with pytest.raises(NoArmature) as empty:
        read_recording(bpy.data.objects.new("Empty", None))
    assert empty.value.object_name == "Empty"


def test_an_armature_without_bones_is_refused() -> None:
    with pytest.raises(NoBones):
        read_recording(rigs.make_armature([]))


def without_animation(armature: bpy.types.Object) -> None:
    armature.animation_data_clear()


def with_strips_alone(armature: bpy.types.Object) -> None:
    data = armature.animation_data
    data.nla_tracks.new().strips.new("strip", 1, data.action)
    data.action = None


def with_an_empty_action(armature: bpy.types.Object) -> None:
    armature.animation_data.action = bpy.data.actions.new("Empty")


def without_a_slot(armature: bpy.types.Object) -> None:
    if bpy.app.version < (4, 4):
        pytest.skip("actions have no slots before Blender 4.4")
    armature.animation_data.action_slot = None


@pytest.mark.parametrize(
    "spoil", [without_animation, with_strips_alone, with_an_empty_action, without_a_slot]
)
def test_an_armature_without_keys_has_no_action(spoil) -> None:
    armature = animated_rig()
    spoil(armature)
    with pytest.raises(NoAction) as fault:
        read_recording(armature)
    assert fault.value.armature == "Rig"


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_a_key_that_is_no_number_is_named(value: float) -> None:
    armature = animated_rig()
    bone = armature.pose.bones["shin"]
    bone.name = 'sh"in'
    curve = next(c for c in curves_of(armature) if fcurves.bone_of(c.data_path) == 'sh"in')
    points = fcurves.keys(curve)
    points[6, 1] = value
    curve.keyframe_points.foreach_set("co", points.astype(np.float32).ravel())
    with pytest.raises(NonFiniteKey) as fault:
        read_recording(armature)
    assert (fault.value.bone, fault.value.frame) == ('sh"in', 7.0)


@pytest.mark.parametrize("scale", [(1, 1, 1.01), (-1, 1, 1), (-2, -2, -2), (0, 0, 0)])
def test_bad_scale_is_refused_also_when_inherited(scale: tuple[float, float, float]) -> None:
    armature = animated_rig()
    armature.scale = scale
    with pytest.raises(BadScale) as own:
        read_recording(armature)
    np.testing.assert_allclose(own.value.scale, scale)
    armature.scale = (1, 1, 1)
    parent = bpy.data.objects.new("Parent", None)
    bpy.context.scene.collection.objects.link(parent)
    parent.scale = scale
    armature.parent = parent
    with pytest.raises(BadScale):
        read_recording(armature)


def test_two_mirrored_axes_are_a_turn() -> None:
    armature = animated_rig()
    armature.scale = (-1, -1, 1)
    assert read_recording(armature).heads.shape == (24, 8, 3)


# --- writing --------------------------------------------------------------------------------


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


# --- both at once, and FBX -------------------------------------------------------------------


def test_side_by_side_shows_the_recording_on_a_copy() -> None:
    armature = animated_rig()
    place_object(armature)
    driver = armature.driver_add('pose.bones["finger"].location', 0).driver
    driver.variables.new().targets[0].id = armature
    constraint = armature.pose.bones["finger"].constraints.new("COPY_ROTATION")
    constraint.target, constraint.subtarget = armature, "hips"
    recording = read_recording(armature)
    recorded = armature.animation_data.action
    track = altered(recording)
    action = write_action(armature, track, name="Adapted")
    copy = side_by_side(armature, recorded, action)
    assert copy.name == "Rig recording"
    assert copy.animation_data.drivers[0].driver.variables[0].targets[0].id == copy
    assert copy.pose.bones["finger"].constraints[0].target == copy
    shown = read_recording(copy)
    np.testing.assert_allclose(shown.heads, recording.heads + np.array([1.5, 0.0, 0.0]), atol=1e-5)
    assert_follows(armature, track)


def test_fbx_holds_that_action_alone_and_leaves_the_scene(tmp_path: Path) -> None:
    armature = animated_rig("XZY")
    place_object(armature)
    other = rigs.make_armature(name="Other")
    recorded = armature.animation_data.action
    track = altered(read_recording(armature, first=5, last=20))
    action = write_action(armature, track, name="Adapted")
    adapted = read_recording(armature)
    slot = fcurves.slot_identifier(armature)
    fcurves.assign(armature, recorded, slot)
    armature.animation_data.nla_tracks.new().strips.new("Strip", 1, recorded)
    armature.animation_data.action_blend_type = "ADD"
    other.select_set(True)
    bpy.context.view_layer.objects.active = other
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 100, 200
    scene.render.fps, scene.render.fps_base = 30, 1.001
    scene.frame_set(3)
    blocks = [set(kind) for kind in (bpy.data.objects, bpy.data.actions, bpy.data.armatures)]

    path = tmp_path / "new" / "adapted.fbx"
    export_fbx(armature, action, path)
    again = reimport_fbx(path, adapted.frames)

    columns = [again.index(bone.name) for bone in adapted.bones]
    np.testing.assert_allclose(again.heads[:, columns], adapted.heads, atol=5e-5)
    assert path.read_bytes().count(b"\x00\x01AnimStack") == 1
    assert b"Other" not in path.read_bytes()
    assert armature.animation_data.action == recorded
    assert armature.animation_data.use_nla
    assert fcurves.slot_identifier(armature) == slot
    assert list(bpy.context.selected_objects) == [other]
    assert bpy.context.view_layer.objects.active == other
    assert (scene.frame_start, scene.frame_end, scene.frame_current) == (100, 200, 3)
    assert blocks == [set(k) for k in (bpy.data.objects, bpy.data.actions, bpy.data.armatures)]


def test_fbx_that_cannot_be_written_is_a_fault(tmp_path: Path) -> None:
    armature = animated_rig()
    (tmp_path / "file").write_text("no folder")
    path = tmp_path / "file" / "adapted.fbx"
    with pytest.raises(OutputNotWritable) as fault:
        export_fbx(armature, armature.animation_data.action, path)
    assert fault.value.path == str(path)


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")  # Blender's importer
def test_a_real_jump_survives_writing_and_fbx(tmp_path: Path) -> None:
    bpy.ops.import_anim.bvh(
        filepath=str(find(JUMP)),
        global_scale=0.05644,
        update_scene_fps=True,
        update_scene_duration=True,
    )
    armature = bpy.context.object
    recording = read_recording(armature)
    moving = tuple(bone.name for bone in recording.bones)
    track = altered(recording, moving)
    action = write_action(armature, track, name="Adapted")
    adapted = assert_follows(armature, track)
    export_fbx(armature, action, tmp_path / "adapted.fbx")
    again = reimport_fbx(tmp_path / "adapted.fbx", adapted.frames)
    columns = [again.index(bone) for bone in moving]
    np.testing.assert_allclose(again.heads[:, columns], adapted.heads, atol=5e-5)
    np.testing.assert_allclose(again.rotations[:, columns], adapted.rotations, atol=2e-4)
