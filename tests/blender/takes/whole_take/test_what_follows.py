"""What comes after the adapted frames is carried along, comes back or is left out, in time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.action_slots import all_curves
from hangtime.bridge.armature import fcurves
from hangtime.bridge.armature.read import read_recording
from hangtime.bridge.rows.choices import After
from hangtime.bridge.takes.write_result import write_result
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.tests.blender.helpers import rigs
from hangtime.tests.blender.takes.whole_take.asked import (
    BLEND,
    FIRST,
    LAST,
    LENGTH,
    MOVED,
    keys_of,
    later,
    motion,
    outside,
    take,
)

pytestmark = pytest.mark.usefixtures("_enabled")

STEADY = ("spine", "head", "foot")  # bones that do not inherit rotation, where that is tried


def as_made(_armature: bpy.types.Object) -> None:
    """Nothing but its curves moves the rig."""


def under_a_moving_parent(armature: bpy.types.Object) -> None:
    parent = bpy.data.objects.new("Parent", None)
    bpy.context.scene.collection.objects.link(parent)
    armature.parent, parent.rotation_euler.z = parent, 0.7
    parent.keyframe_insert("location", frame=1)
    parent.location = (0.4, 0.1, 0.0)
    parent.keyframe_insert("location", frame=LENGTH)


def not_turned_by_parents(armature: bpy.types.Object) -> None:
    for bone in STEADY:
        armature.data.bones[bone].use_inherit_rotation = False


@pytest.mark.parametrize("set_up", [as_made, under_a_moving_parent, not_turned_by_parents])
@pytest.mark.parametrize("mode", ["QUATERNION", "XYZ"])
def test_what_follows_is_carried_along_rigidly(
    mode: str, set_up: Callable[[bpy.types.Object], None]
) -> None:
    armature = take(mode)
    set_up(armature)
    before, recording = keys_of(armature), read_recording(armature)
    write_result(armature, motion(recording, MOVED), name="Result")
    now, after = read_recording(armature), keys_of(armature)
    rest = recording.frames > LAST + BLEND
    turn = axis_rotation(2, MOVED.turn)
    heads = (recording.heads[rest] - MOVED.pivot) @ turn.T + MOVED.pivot + MOVED.shift
    np.testing.assert_allclose(now.heads[rest], heads, atol=1e-6)
    np.testing.assert_allclose(now.rotations[rest], turn @ recording.rotations[rest], atol=3e-6)
    jumps = np.linalg.norm(np.diff(now.heads[:, 0], axis=0), axis=1)
    assert jumps.max() < 0.2
    carrying = {"hips", *(STEADY if set_up is not_turned_by_parents else ())}
    for channel, keys in before.items():
        if fcurves.bone_of(channel[0]) not in carrying:
            own = outside(after[channel], FIRST - BLEND, LAST + BLEND)
            assert own == outside(keys, FIRST - BLEND, LAST + BLEND)


def test_a_take_returns_by_a_frame() -> None:
    armature = take()
    before, recording = keys_of(armature), read_recording(armature)
    asked = motion(recording, MOVED, after=After.RETURN, return_frame=85.0)
    _, written = write_result(armature, asked, name="Result")
    assert written is not None
    assert written.back == 85.0
    now, after = read_recording(armature), keys_of(armature)
    for channel, keys in before.items():
        assert outside(after[channel], FIRST - BLEND, 85.0) == outside(keys, FIRST - BLEND, 85.0)
    left = np.linalg.norm(now.heads[:, 0] - recording.heads[:, 0], axis=1)
    assert left[LAST - 1] > 0.3
    assert np.abs(np.diff(now.heads[LAST - 1 :, 0], 2, axis=0)).max() < 0.05
    assert left[85:].max() == 0.0


@pytest.mark.parametrize("ends", [False, True])
def test_where_nothing_follows_nothing_is_carried_or_comes_back(ends: bool) -> None:
    armature = take()
    recording = read_recording(armature)
    asked = motion(recording, MOVED, after=After.RETURN)
    if not ends:
        for curve in fcurves.curves_of(armature):
            fcurves.crop(curve, 1.0, LAST)
    _, written = write_result(armature, replace(asked, ends=ends), name="Result")
    assert written is not None
    assert (written.moved, written.back) == (None, None)
    now = read_recording(armature)
    assert now.frames[[0, -1]].tolist() == [1.0, LAST]
    np.testing.assert_allclose(now.heads[-1, 0], asked.track.root_head[-1], atol=2e-6)


@pytest.mark.parametrize("locked", [False, True])
def test_what_follows_comes_as_much_later_as_the_frames_take_longer(locked: bool) -> None:
    armature = take()
    armature.pose.bones["finger"]["smile"] = 0.0
    for frame, value in ((10, 0.1), (45, 0.2), (90, 0.9)):
        armature.pose.bones["finger"]["smile"] = value
        armature.pose.bones["finger"].keyframe_insert('["smile"]', frame=frame)
    before, recording = keys_of(armature), read_recording(armature)
    _, written = write_result(armature, later(recording, lock_others=locked), name="Result")
    assert written is not None
    assert written.later == 3
    after = keys_of(armature)
    for channel, keys in before.items():
        now, bone = after[channel], fcurves.bone_of(channel[0])
        if bone not in rigs.MOVING and locked:
            assert now.tobytes() == keys.tobytes()
            continue
        tail = keys[keys[:, 0] >= LAST + BLEND]
        tail[:, [0, 2, 4]] += 3.0
        assert now[now[:, 0] >= LAST + BLEND + 3.0].tobytes() == tail.tobytes()
        head = keys[keys[:, 0] <= FIRST - BLEND]
        assert now[now[:, 0] <= FIRST - BLEND].tobytes() == head.tobytes()
    smile = after['pose.bones["finger"]["smile"]', 0]
    assert smile[:, 0] == pytest.approx([10.0, 45.0, 90.0] if locked else [10.0, 46.7, 93.0])
    assert smile[:, 1] == pytest.approx([0.1, 0.2, 0.9])


def test_markers_and_other_slots_go_along_in_time() -> None:
    armature = take()
    action = armature.animation_data.action
    action.pose_markers.new("Early").frame = 20
    action.pose_markers.new("Late").frame = 80
    if bpy.app.version >= (4, 4):
        face = action.slots.new("KEY", "Face")
        bag = action.layers[0].strips[0].channelbag(face, ensure=True)
        smile = bag.fcurves.new('key_blocks["smile"].value')
        smile.keyframe_points.insert(20.0, 0.0)
        smile.keyframe_points.insert(80.0, 1.0)
    result, _ = write_result(armature, later(read_recording(armature)), name="Result")
    assert [marker.frame for marker in result.pose_markers] == [20, 83]
    assert [marker.frame for marker in action.pose_markers] == [20, 80]
    if bpy.app.version >= (4, 4):
        curves = [c for c in all_curves(result) if "smile" in c.data_path]
        assert fcurves.keys(curves[0]).tolist() == [[20.0, 0.0], [83.0, 1.0]]


def test_after_a_hold_that_ends_nothing_follows() -> None:
    armature = take()
    recording = read_recording(armature)
    write_result(armature, replace(motion(recording), ends=True), name="Result")
    assert read_recording(armature).frames[[0, -1]].tolist() == [1.0, LAST]


def test_cut_leaves_the_adapted_frames_alone() -> None:
    armature = take()
    asked = motion(read_recording(armature), after=After.CUT)
    action, written = write_result(armature, asked, name="Result")
    assert written is None
    assert action.frame_range.to_tuple() == (FIRST, LAST)


@pytest.mark.parametrize(
    ("ends", "after", "cyclic", "now"),
    [
        ((1.0, LENGTH), After.CARRY, True, (1.0, LENGTH)),
        ((FIRST, LAST - 5.0), After.CARRY, False, (FIRST, LAST)),
        ((1.0, LAST + BLEND - 2.0), After.CARRY, False, (1.0, LAST + BLEND - 2.0)),
        ((1.0, LENGTH), After.CUT, False, (FIRST, LAST)),
    ],
)
def test_a_manual_frame_range_holds_the_adapted_frames(
    ends: tuple[float, float], after: After, cyclic: bool, now: tuple[float, float]
) -> None:
    """Exports go by it: half of two adapted cycles was left out, as a loop."""
    armature = take()
    recorded = armature.animation_data.action
    asked = motion(read_recording(armature), after=after)
    recorded.use_frame_range = recorded.use_cyclic = True
    recorded.frame_start, recorded.frame_end = ends
    action, _ = write_result(armature, asked, name="Result")
    assert action.use_cyclic == cyclic
    assert (action.frame_start, action.frame_end) == now
