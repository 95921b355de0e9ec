"""Presets on a recorded jump, and a cone of the list that an adaptation keeps."""

from __future__ import annotations

from math import degrees, radians

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.poses import sample
from hangtime.bridge.constraint_kinds import KINDS
from hangtime.bridge.constraints.requests import requests_of
from hangtime.bridge.constraints.rest_figure import (
    directions,
    parts_of,
    rest_figure,
    rest_rotations,
)
from hangtime.bridge.constraints.rows import add_constraint, hold_throughout
from hangtime.bridge.rows.phases import phases_of
from hangtime.tests.blender.helpers import rigs
from hangtime.tests.blender.helpers.rows import asked, names, select
from hangtime.tests.helpers.clips import JUMP_FRAMES

pytestmark = pytest.mark.usefixtures("_enabled")

JUMP = "forward_jump_116cm.bvh"
FIRST, LAST = JUMP_FRAMES


def seen(armature: bpy.types.Object, bone: str, first: float, last: float) -> np.ndarray:
    """(T, 3) directions of a bone against its parent in the motion that is shown."""
    poses = sample(armature, np.arange(np.ceil(first), np.floor(last) + 1.0))
    figure = rest_figure(armature, parts_of(armature), poses.object_to_world[0])
    return directions(poses, figure, rest_rotations(armature))[bone]


# ---------------------------------------------------------------- joints


def test_joint_limits_fit_the_figure_and_say_what_the_recording_breaks(
    jump: bpy.types.Object, capfd: pytest.CaptureFixture[str]
) -> None:
    assert bpy.ops.hangtime.preset_joint_limits() == {"FINISHED"}
    told = capfd.readouterr().out
    limits = requests_of(jump.hangtime, jump)
    knee = next(limit for limit in limits.angles if limit.bone == "LeftLeg")
    assert (degrees(knee.lower), degrees(knee.upper)) == pytest.approx((-10.0, 135.0), abs=1e-3)
    hip = next(cone for cone in limits.cones if cone.bone == "RightUpLeg")
    assert hip.axis[0] < 0.0  # outwards, to the figure's right
    assert hip.axis[1] == pytest.approx(hip.axis[2])  # half-way between down and forward, -Y
    assert {cone.bone for cone in limits.cones} >= {"LeftArm", "LeftHand", "Spine", "Neck", "Head"}
    assert "Added 18 joint limits" in told
    broken = {row.name for row in jump.hangtime.constraints if row.status}
    assert {"Left Ankle Range", "Right Ankle Range"} <= broken  # feet bend more under load
    assert not {"Left Knee Range", "Right Elbow Range", "Left Hip Range"} & broken
    assert "the recording itself goes beyond Right Ankle Range by" in told


def test_a_limit_says_by_how_much_the_recording_goes_beyond(jump: bpy.types.Object) -> None:
    bpy.ops.hangtime.preset_joint_limits()
    row = jump.hangtime.constraints["Left Ankle Range"]
    shin = rest_figure(jump, parts_of(jump), np.array(jump.matrix_world)).along["LeftLeg"]
    bend = np.degrees(np.arccos(np.clip(seen(jump, "LeftFoot", FIRST, LAST) @ shin, -1.0, 1.0)))
    over = max(bend.max() - degrees(row.upper), degrees(row.lower) - bend.min())
    told = float(row.status.removeprefix("The recording goes ").removesuffix("° beyond"))
    assert told == pytest.approx(over, abs=2.0)  # it was looked at now and then only


def test_a_part_of_a_name_that_none_has_is_left_out(jump: bpy.types.Object) -> None:
    """As a script may call it."""
    named = parts_of(jump)
    part = jump.hangtime.parts.add()
    part.name, part.bone = "Landing", "Hips"
    assert parts_of(jump) == named


def test_joints_without_a_bone_are_named(
    jump: bpy.types.Object, capfd: pytest.CaptureFixture[str]
) -> None:
    bpy.ops.object.mode_set(mode="EDIT")
    for name in ("LeftHand", "RightHand"):
        bone = jump.data.edit_bones[name]
        for below in (*bone.children_recursive, bone):
            jump.data.edit_bones.remove(below)
    bpy.ops.object.mode_set(mode="OBJECT")
    assert bpy.ops.hangtime.preset_joint_limits() == {"FINISHED"}
    assert "no bone for left wrist, right wrist" in capfd.readouterr().out
    assert not [name for name in names(jump) if "Wrist" in name]


def test_an_armature_that_is_no_figure_gets_no_limits() -> None:
    rigs.reset()
    armature = rigs.make_armature()
    for preset in (bpy.ops.hangtime.preset_joint_limits, bpy.ops.hangtime.preset_joint_strength):
        with pytest.raises(RuntimeError, match="No bones of joints were found"):
            preset()
    assert names(armature) == []


def test_strength_grows_with_mass_and_height(jump: bpy.types.Object) -> None:
    settings = jump.hangtime
    settings.mass, settings.use_height, settings.height = 70.0, True, 1.75
    assert bpy.ops.hangtime.preset_joint_strength() == {"FINISHED"}
    limits = asked(jump).torques
    assert [limit.name for limit in limits] == ["Hip Strength", "Knee Strength", "Ankle Strength"]
    weight_height = 70.0 * 9.81 * 1.75
    shares = [limit.bound / weight_height for limit in limits]
    assert shares == pytest.approx([0.161, 0.163, 0.095], abs=1e-4)
    assert limits[1].bones == ("LeftLeg", "RightLeg")


# ---------------------------------------------------------------- the others


def test_a_softer_landing_needs_a_landing(jump: bpy.types.Object) -> None:
    with pytest.raises(RuntimeError, match="no landing is known"):
        bpy.ops.hangtime.preset_soft_landing()
    assert names(jump) == []


def test_a_softer_landing_caps_the_last_ground_phase(analysed: bpy.types.Object) -> None:
    assert bpy.ops.hangtime.preset_soft_landing() == {"FINISHED"}
    (force,) = asked(analysed).forces
    assert (force.when.phase, force.peak) == ("ground 2", 3.0)


def test_a_limp_limb_is_the_bone_and_what_hangs_on_it(jump: bpy.types.Object) -> None:
    assert not bpy.ops.hangtime.preset_limp_limb.poll()
    select(jump, "LeftArm")
    assert bpy.ops.hangtime.preset_limp_limb() == {"FINISHED"}
    (limp,) = asked(jump).torques
    assert limp.bones == ("LeftArm", "LeftForeArm", "LeftHand")  # fingers have no bodies
    assert limp.bound == 0.0


def test_a_weight_is_carried_at_each_selected_bone(jump: bpy.types.Object) -> None:
    select(jump, "LeftHand", "RightHand")
    assert bpy.ops.hangtime.preset_carry_weight() == {"FINISHED"}
    loads = asked(jump).body.added
    assert [(load.bone, load.mass) for load in loads] == [("LeftHand", 10.0), ("RightHand", 10.0)]


# ---------------------------------------------------------------- end to end


@pytest.mark.slow
def test_an_adaptation_keeps_a_cone_of_the_list(analysed: bpy.types.Object) -> None:
    flight = next(phase for phase in phases_of(analysed.hangtime) if not phase.is_ground)
    before = seen(analysed, "LeftArm", flight.start, flight.end)
    axis = before.mean(axis=0) / np.linalg.norm(before.mean(axis=0))
    widest = np.degrees(np.arccos(np.clip(before @ axis, -1.0, 1.0))).max()
    row = add_constraint(analysed, KINDS["CONE"], ["LeftArm"], flight.start + 10.0)
    assert row.phase == flight.name
    row.use_axis, row.axis = True, axis.tolist()
    row.half_angle = radians(0.7 * widest)
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    after = seen(analysed, "LeftArm", flight.start, flight.end)
    leaned = np.degrees(np.arccos(np.clip(after @ axis, -1.0, 1.0))).max()
    assert leaned < 0.7 * widest + 0.5
    row = analysed.hangtime.constraints[0]
    assert (row.met, row.status) == ("MET", "Met")
    hold_throughout(row)
    assert row.status == ""
