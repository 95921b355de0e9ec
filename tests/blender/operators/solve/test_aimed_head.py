"""A head that a constraint aims looks there in the result, too; the rest of the body is adapted."""

from __future__ import annotations

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.actions import read_recorded
from hangtime.bridge.armature.incremental import complete
from hangtime.bridge.controls.driven import acting_on
from hangtime.bridge.controls.missed.aimed import AIMABLE, LedBones, aimed_in, led_bones
from hangtime.solver.body.anatomy import map_anatomy
from hangtime.solver.body.character import build_character
from hangtime.solver.data.recording import PoseTrack
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.tests.blender.helpers.actions import curves_of, snapshot
from hangtime.tests.blender.helpers.jump_scene import FIRST, LAST, SceneState, ask_by_text

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


def test_a_neck_bone_that_never_bends_may_be_held(jump: bpy.types.Object) -> None:
    """It is one body with the bone below it, and in no solution by its own name."""
    hold = jump.pose.bones["Neck1"].constraints.new("LIMIT_ROTATION")
    hold.owner_space = "LOCAL"
    hold.use_limit_x = hold.use_limit_y = hold.use_limit_z = True
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    told = "Left to constraints (Limit Rotation), as in the recording: Head, up to"
    assert told in jump.hangtime.status


def test_what_is_asked_of_an_aimed_head_is_refused_by_name(jump: bpy.types.Object) -> None:
    look_ahead(jump, "Head")
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    ask_by_text(jump, '[[orientation]]\nname = "Look up"\nbone = "Head"\ntilt = -20\n')
    before = SceneState.of(jump)
    with pytest.raises(RuntimeError, match=r"“Look up” is about the bone “Head”.*mute what aims"):
        bpy.ops.hangtime.adapt()
    assert SceneState.of(jump) == before


def test_a_pose_of_the_whole_body_leaves_an_aimed_head_out_and_says_so(
    jump: bpy.types.Object,
) -> None:
    look_ahead(jump, "Head")
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    pose = '[[pose]]\nname = "Tuck"\nphase = "flight 1"\nmoment = "apex"\nslack = 20\n'
    ask_by_text(jump, pose)
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    told = "The pose “Tuck” is about the rest of the body: Head stays aimed"
    assert told in jump.hangtime.status.splitlines()
    assert told in jump.hangtime.adapted.hangtime.report.splitlines()


def test_what_hangs_on_an_aimed_neck_goes_with_it(jump: bpy.types.Object) -> None:
    look_ahead(jump, "Neck")
    recording = read_recorded(jump, FIRST, LAST)
    segments = map_anatomy(recording.bones)
    above = [recording.bones[s.bone].name for s in segments if s.part in AIMABLE]
    assert above[0] == "Neck"
    assert above[-1] == "Head"
    led = complete(led_bones(jump, recording.bones, segments, recording.frames))
    assert led == LedBones(tuple(above))


def test_how_far_the_centre_of_mass_is_off_is_told(jump: bpy.types.Object) -> None:
    """As by turning neck and head as one solid about the neck's joint."""
    whole, degrees = read_recorded(jump, FIRST, LAST), 20.0
    bodies, few = build_character(whole).bodies, whole.part(slice(0, 20))
    turn = axis_rotation(0, np.radians(degrees))
    above = [body for body in bodies if body.part in AIMABLE]
    bones = [few.index(body.bone) for body in bodies]
    rotations = few.rotations[:, bones]
    aimed = [body in above for body in bodies]
    rotations[:, aimed] = turn @ rotations[:, aimed]
    names = tuple(body.bone for body in bodies)
    track = PoseTrack(few.frames, names, rotations, few.heads[:, bones[0]])
    joint, moved = few.heads[:, few.index(above[0].bone)], np.zeros((20, 3))
    for body in above:
        bone = few.index(body.bone)
        placed = few.rotations[:, bone] @ (few.bones[bone].rotation.T @ body.com)
        moved += body.mass * (few.heads[:, bone] + placed - joint) @ (turn - np.eye(3)).T
    shift = np.linalg.norm(moved, axis=1).max() / sum(body.mass for body in bodies)
    told = aimed_in(jump, [body.bone for body in above], track, bodies)
    assert told is not None
    assert told.degrees == pytest.approx(degrees, abs=0.01)
    assert told.mm == pytest.approx(1e3 * shift, rel=1e-3)
    assert told.mm > 1.0


def test_all_that_aims_is_named_and_nothing_else(jump: bpy.types.Object) -> None:
    look_ahead(jump, "Neck")
    idle = jump.pose.bones["Head"].constraints.new("COPY_ROTATION")
    idle.target, idle.influence = bpy.data.objects["Goal"], 0.0
    assert acting_on(jump, ["Neck", "Head"]) == ("Damped Track",)
    bpy.ops.object.mode_set(mode="EDIT")
    head = jump.data.edit_bones["Head"]
    tip = jump.data.edit_bones.new("Look")
    tip.head, tip.tail, tip.parent = head.tail, head.tail + head.vector, head
    bpy.ops.object.mode_set(mode="OBJECT")
    pull = jump.pose.bones["Look"].constraints.new("IK")
    pull.target, pull.chain_count = bpy.data.objects["Goal"], 2
    assert acting_on(jump, ["Neck", "Head"]) == ("Damped Track", "IK")
    assert acting_on(jump, ["Head"]) == ("IK",)


def test_drivers_are_named_beside_constraints(jump: bpy.types.Object) -> None:
    look_ahead(jump, "Neck")
    mode = jump.pose.bones["Head"].rotation_mode
    path = "rotation_quaternion" if mode == "QUATERNION" else "rotation_euler"
    jump.pose.bones["Head"].driver_add(path, 1).driver.expression = "0.05 * sin(frame / 20)"
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    told = "Left to constraints (Damped Track) and drivers, as in the recording: Neck"
    assert told in jump.hangtime.status


def test_a_constraint_on_the_chest_is_refused_as_before(jump: bpy.types.Object) -> None:
    look_ahead(jump, "Head")
    hold = jump.pose.bones["Spine1"].constraints.new("DAMPED_TRACK")
    hold.target = bpy.data.objects["Goal"]
    before = SceneState.of(jump)
    with pytest.raises(RuntimeError, match="pose the bones Spine1 otherwise than their keys"):
        bpy.ops.hangtime.analyze()
    assert SceneState.of(jump) == before
    assert curves_of(jump)
