"""What is read of Blender's armatures and actions, in the bpy module."""

from __future__ import annotations

import math

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature import fcurves, incremental, read
from hangtime.bridge.armature.channels import proper
from hangtime.bridge.armature.incremental import FEWEST_FRAMES
from hangtime.bridge.armature.poses import evaluated
from hangtime.bridge.armature.read import read_recording, record_incrementally
from hangtime.solver.arrays import FloatArray
from hangtime.solver.data.faults import (
    BadScale,
    NoAction,
    NoArmature,
    NoBones,
    NonFiniteKey,
)
from hangtime.tests.blender.helpers import rigs
from hangtime.tests.blender.helpers.actions import (
    animated_rig,
    curves_of,
    place_object,
)


@pytest.fixture(autouse=True)
def _empty_scene() -> None:
    rigs.reset()


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
    collection = in_collection(armature)
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


@pytest.mark.parametrize("how", ["keys", "driver"])
def test_reads_what_keys_or_a_driver_hide(how: str) -> None:
    armature = animated_rig()
    shown = read_recording(armature)
    armature.hide_viewport = True
    if how == "keys":
        armature.keyframe_insert("hide_viewport", frame=1)
        curves = list(curves_of(armature))
    else:
        armature.driver_add("hide_viewport").driver.expression = "True"
        curves = list(armature.animation_data.drivers)
    bpy.context.scene.frame_set(2)
    np.testing.assert_array_equal(read_recording(armature).rotations, shown.rotations)
    assert armature.hide_viewport
    assert not any(curve.mute for curve in curves)


def test_what_is_seen_already_is_not_told_so_again() -> None:
    """Blender would copy all of its keys anew, at each of the thousand slices of a long take."""

    class Seen:
        name, hide_viewport, data, animation_data = animated_rig().name, False, None, None

        def __setattr__(self, name: str, value: object) -> None:
            raise AssertionError(f"{name} was set to {value}")

    with evaluated([Seen()]):
        pass


def in_collection(thing: bpy.types.Object) -> bpy.types.Collection:
    """A collection that holds an object, which the scene's own no longer does."""
    collection = bpy.data.collections.new("Characters")
    bpy.context.scene.collection.children.link(collection)
    collection.objects.link(thing)
    bpy.context.scene.collection.objects.unlink(thing)
    bpy.context.view_layer.update()
    return collection


def test_what_is_seen_in_a_collection_is_read_where_it_is() -> None:
    """To link it elsewhere for each slice, Blender would go through all objects of the scene."""
    armature = animated_rig()
    shown = read_recording(armature)
    in_collection(armature)
    with evaluated([armature]):
        assert armature.name not in bpy.context.scene.collection.objects
    np.testing.assert_array_equal(read_recording(armature).heads, shown.heads)


@pytest.mark.parametrize("how", ["eye", "collection's eye", "collection's screen", "armature's"])
def test_reads_what_is_hidden_in_a_collection(how: str) -> None:
    armature = animated_rig()
    shown = read_recording(armature)
    collection = in_collection(armature)
    layer = bpy.context.view_layer.layer_collection.children[collection.name]
    if how == "eye":
        armature.hide_set(True)
    elif how == "collection's eye":
        layer.hide_viewport = True
    elif how == "collection's screen":
        collection.hide_viewport = True
    else:
        armature.hide_viewport = True
    np.testing.assert_array_equal(read_recording(armature).heads, shown.heads)
    np.testing.assert_array_equal(read_recording(armature).rotations, shown.rotations)


def test_what_is_read_in_parts_is_converted_in_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    armature = animated_rig()
    place_object(armature)
    whole, converted = read_recording(armature), []

    def counted(matrices: FloatArray) -> FloatArray:
        converted.append(len(matrices))
        return proper(matrices)

    monkeypatch.setattr(incremental, "SLICE_S", 0.0)
    monkeypatch.setattr(read, "proper", counted)
    parts = record_incrementally(armature, whole.frames)
    try:
        while True:
            next(parts)
    except StopIteration as end:
        found = end.value
    assert max(converted) <= FEWEST_FRAMES < len(whole.frames)
    np.testing.assert_array_equal(found.heads, whole.heads)
    np.testing.assert_array_equal(found.rotations, whole.rotations)
    assert [bone.name for bone in found.bones] == [bone.name for bone in whole.bones]


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


def with_an_empty_action(armature: bpy.types.Object) -> None:
    armature.animation_data.action = bpy.data.actions.new("Empty")


def without_a_slot(armature: bpy.types.Object) -> None:
    if bpy.app.version < (4, 4):
        pytest.skip("actions have no slots before Blender 4.4")
    armature.animation_data.action_slot = None


@pytest.mark.parametrize("spoil", [without_animation, with_an_empty_action, without_a_slot])
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


def test_a_curve_without_keys_is_no_fault() -> None:
    armature = animated_rig()
    curves_of(armature)[0].keyframe_points.clear()
    assert len(read_recording(armature).frames) > 1


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
