"""A head that a constraint aims looks there in the result, too; the rest of the body is adapted."""

from __future__ import annotations

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.tests.blender.helpers.actions import curves_of, snapshot
from hangtime.tests.blender.helpers.jump_scene import FIRST, LAST, SceneState

pytestmark = [pytest.mark.usefixtures("_enabled"), pytest.mark.slow]

AHEAD = 5.0  # m
STEP = 10  # frames


def look_ahead(armature: bpy.types.Object, bone: str) -> None:
    """Have a bone look at an empty ahead of the landing."""
    first, last = (world(armature, "Hips", frame).translation for frame in (FIRST, LAST))
    way = (last - first).normalized()
    head = world(armature, bone, LAST)
    target = bpy.data.objects.new("Goal", None)
    bpy.context.scene.collection.objects.link(target)
    target.location = head.translation + AHEAD * way
    hold = armature.pose.bones[bone].constraints.new("DAMPED_TRACK")
    hold.target, hold.track_axis = target, "TRACK_Z"
    assert head.to_3x3().col[2].dot(way) > 0.9


def world(armature: bpy.types.Object, bone: str, frame: int) -> bpy.types.bpy_struct:
    """A bone's pose in the world, as the frame shows it."""
    bpy.context.scene.frame_set(frame)
    return armature.matrix_world @ armature.pose.bones[bone].matrix


def test_the_head_goes_on_looking_and_the_jump_is_adapted(jump: bpy.types.Object) -> None:
    look_ahead(jump, "Head")
    recorded = jump.animation_data.action
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    keys = snapshot(recorded, jump)
    jump.hangtime.stances["ground 2"].forward = 0.3
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    assert snapshot(recorded, jump) == keys
    lines = jump.hangtime.status.splitlines()
    (told,) = [line for line in lines if line.startswith("Left to constraints (Damped Track)")]
    assert "in the recording: Head, up to" in told
    assert told in jump.hangtime.adapted.hangtime.report
    assert not jump.hangtime.adapted.hangtime.warning  # so near is as good
    assert not any("Constraints keep" in line for line in lines)
    (hold,) = jump.pose.bones["Head"].constraints
    assert not hold.mute
    goal = bpy.data.objects["Goal"].matrix_world.translation
    for frame in np.arange(FIRST, LAST, STEP).tolist():
        head = world(jump, "Head", frame)
        assert head.to_3x3().col[2].dot((goal - head.translation).normalized()) > 0.999


def test_far_from_the_solution_it_is_warned_about(jump: bpy.types.Object) -> None:
    look_ahead(jump, "Head")
    bpy.data.objects["Goal"].location = world(jump, "Head", LAST).translation
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    jump.hangtime.stances["ground 2"].forward = 0.3
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    warning = jump.hangtime.adapted.hangtime.warning
    assert "mute them, or bake the action" in warning


def test_neck_and_head_that_drivers_turn_are_left_to_them(jump: bpy.types.Object) -> None:
    mode = jump.pose.bones["Head"].rotation_mode
    path = "rotation_quaternion" if mode == "QUATERNION" else "rotation_euler"
    jump.pose.bones["Head"].driver_add(path, 1).driver.expression = "0.05 * sin(frame / 20)"
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    assert "Left to drivers, as in the recording: Head" in jump.hangtime.status


def test_a_constraint_on_the_chest_is_refused_as_before(jump: bpy.types.Object) -> None:
    look_ahead(jump, "Head")
    hold = jump.pose.bones["Spine1"].constraints.new("DAMPED_TRACK")
    hold.target = bpy.data.objects["Goal"]
    before = SceneState.of(jump)
    with pytest.raises(RuntimeError, match="pose the bones Spine1 otherwise than their keys"):
        bpy.ops.hangtime.analyze()
    assert SceneState.of(jump) == before
    assert curves_of(jump)
