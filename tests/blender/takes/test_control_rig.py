"""Results on rigs that are posed through controls, and on those that only look like such."""

from __future__ import annotations

import re

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.read import read_recording, record
from hangtime.bridge.controls.driven import is_driven
from hangtime.bridge.recipe.result import ResultOptions
from hangtime.bridge.takes.plan import AdaptedMotion
from hangtime.bridge.takes.write_result import write_result
from hangtime.devtools.rigs.controls.cases import performer as jumper
from hangtime.devtools.rigs.generated import SWITCH, generated_human, perform
from hangtime.solver.data.recording import PoseTrack
from hangtime.solver.data.reports.jumps import TimeMap
from hangtime.tests.blender.helpers.actions import curves_of, snapshot
from hangtime.tests.helpers.clips import JUMP_FRAMES

MOVED = 0.2  # m
TOE = "DEF-toe.L"

pytestmark = pytest.mark.usefixtures("_enabled")


@pytest.mark.slow
def test_a_generated_rig_lands_further_on_by_keys_on_its_controls() -> None:
    performer = jumper()
    rig = generated_human(performer, arms=1.0, legs=1.0)
    bpy.context.scene.render.fps = 24
    perform(rig, performer)
    bpy.context.view_layer.objects.active = rig
    take = rig.animation_data.action
    keys, before = snapshot(take, rig), read_recording(rig)
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    settings = rig.hangtime
    settings.keep_times = True
    settings.stances["ground 2"].forward = MOVED
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    result, after = rig.animation_data.action, read_recording(rig)
    assert result != take
    assert snapshot(take, rig) == keys
    keyed = {re.findall(r'"(.*?)"', curve.data_path)[0] for curve in curves_of(rig)}
    assert {"torso", "thigh_fk.L", "foot_fk.R", "hand_fk.R"} <= keyed
    assert not [bone for bone in keyed if bone.startswith(("DEF-", "ORG-", "MCH-"))]
    told = re.search(
        r"The controls miss the solution: (\S+) by ([\d.]+) mm \(frame (\d+)\), (\S+) by",
        settings.status,
    )
    assert told is not None, settings.status
    # A spine that bends as its chest turns cannot follow each bone of the solution.
    assert told[1].startswith("DEF-spine")
    assert 1.0 < float(told[2]) < 40.0
    # Feet skate in this take, for the actor has other hips; the landing is held, and further on.
    toe, landed = before.index(TOE), slice(-12, None)
    was, now = before.heads[landed, toe], after.heads[landed, toe]
    assert np.linalg.norm(np.ptp(was, axis=0)) > 0.01
    assert np.ptp(now[:, 1]) < 0.003
    assert (was - now).mean(0) == pytest.approx([0.0, MOVED, 0.0], abs=0.03)


def test_limbs_in_inverse_kinematics_are_refused_before_a_solve() -> None:
    rig = generated_human(jumper(), arms=1.0, legs=1.0)
    torso = rig.pose.bones["torso"]
    for frame in (1, 51):
        torso.keyframe_insert("location", frame=frame)
    leg = rig.pose.bones["thigh_parent.L"]
    for frame, switch in ((1, 1.0), (30, 1.0), (31, 0.0)):
        leg[SWITCH] = switch
        leg.keyframe_insert(f'["{SWITCH}"]', frame=frame)
    bpy.context.view_layer.objects.active = rig
    with pytest.raises(
        RuntimeError, match=r"Inverse kinematics poses .*ORG-shin\.L.*to FK"
    ) as told:
        bpy.ops.hangtime.analyze()
    assert "shin.R" not in str(told.value)
    assert "forearm" not in str(told.value)


def test_bones_that_follow_another_armature_are_refused_before_a_solve(
    jump: bpy.types.Object,
) -> None:
    other = jump.copy()
    other.animation_data_clear()
    bpy.context.scene.collection.objects.link(other)
    other.animation_data_create().action = bpy.data.actions.new("Breath")
    for bone in other.pose.bones:
        follow = bone.constraints.new("COPY_TRANSFORMS")
        follow.target, follow.subtarget = jump, bone.name
    prop = other.pose.bones["LeftHandIndex1"]
    for frame in JUMP_FRAMES:
        prop.keyframe_insert("location", frame=frame)
    bpy.context.view_layer.objects.active = other
    with pytest.raises(RuntimeError, match="follow constraints, and no bone that you can pose"):
        bpy.ops.hangtime.analyze()


def test_a_constraint_on_a_finger_diverts_nothing(jump: bpy.types.Object) -> None:
    finger = jump.pose.bones["LeftHandIndex1"].constraints.new("COPY_ROTATION")
    finger.target, finger.subtarget = jump, "RightHandIndex1"
    head = jump.pose.bones["Head"].constraints.new("COPY_ROTATION")  # keys pose it beside
    head.target, head.subtarget, head.influence = jump, "Neck", 0.3
    thigh = jump.pose.bones["LeftUpLeg"].constraints.new("LIMIT_ROTATION")
    thigh.use_limit_y = True
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    bodies = [part.bone for part in jump.hangtime.parts if part.bone]
    assert bodies[0] == "Hips"
    assert not is_driven(jump, bodies)
    shown = record(jump, np.arange(100.0, 110.0))
    columns = [shown.index(body) for body in bodies]
    places = shown.heads[:, columns[0]] + [0.0, 0.0, 0.1]
    moved = PoseTrack(shown.frames, tuple(bodies), shown.rotations[:, columns], places)
    span = (100.0, 109.0)
    motion = AdaptedMotion(moved, TimeMap(span, span), None, ResultOptions())
    _, written = write_result(jump, motion, name="moved")
    assert written is not None
    assert written.controls is None
    higher = record(jump, moved.frames).heads[:, columns[0]]
    np.testing.assert_allclose(higher, places, atol=1e-4)
