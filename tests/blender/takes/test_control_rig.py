"""Results on rigs that are posed through controls, and on those that only look like such."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.incremental import complete
from hangtime.bridge.armature.poses import sample
from hangtime.bridge.armature.read import read_recording, record
from hangtime.bridge.controls.control_rig import (
    ControlPoses,
    carried_controls,
    control_poses,
    found_controls,
)
from hangtime.bridge.controls.driven import is_driven
from hangtime.bridge.controls.needed import LEVER, Effects, needed
from hangtime.bridge.controls.posing import Posed, Posing
from hangtime.bridge.controls.refusals import unled
from hangtime.bridge.recipe.result import ResultOptions
from hangtime.bridge.takes.plan import AdaptedMotion
from hangtime.bridge.takes.write_result import write_result
from hangtime.devtools.rigs.controls.cases import performer as jumper
from hangtime.devtools.rigs.controls.rigify import rigify_human
from hangtime.devtools.rigs.generated import SWITCH, generated_human
from hangtime.solver.body.anatomy import map_anatomy
from hangtime.solver.data.recording import PoseTrack, Recording
from hangtime.solver.data.reports.jumps import TimeMap
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.tests.blender.helpers.actions import curves_of, snapshot
from hangtime.tests.blender.helpers.ik_rig import ik_rig
from hangtime.tests.helpers.clips import JUMP_FRAMES
from mathutils import Matrix

MOVED, HIGHER = 0.2, 0.04  # m
TOE = "DEF-toe.L"
FLAT = {"Left heel 1", "Right heel 1", "Left heel 2"}  # as long as these stand, the toes do

pytestmark = pytest.mark.usefixtures("_enabled")


def performing(*, ik: bool) -> bpy.types.Object:
    """The generated rig with the jump on its controls, limbs in inverse kinematics or forward."""
    rig = rigify_human(jumper(), ik=ik, rate=24)
    bpy.context.view_layer.objects.active = rig
    return rig


def land_further(rig: bpy.types.Object) -> set[str]:
    """Adapt the jump to a landing further on; returns the bones with keys."""
    take = rig.animation_data.action
    keys = snapshot(take, rig)
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}
    settings = rig.hangtime
    settings.keep_times = True
    settings.stances["ground 2"].forward = MOVED
    assert bpy.ops.hangtime.adapt() == {"FINISHED"}
    assert rig.animation_data.action != take
    assert snapshot(take, rig) == keys
    keyed = {re.findall(r'"(.*?)"', curve.data_path)[0] for curve in curves_of(rig)}
    assert not [bone for bone in keyed if bone.startswith(("DEF-", "ORG-", "MCH-"))]
    return keyed


def misses(status: str) -> tuple[float, float]:
    """How far bones are from the solution, in mm and degrees, as the status tells."""
    told = status[status.index("controls have keys") :].replace("more than 1 mm or 0.2°", "")
    mm, degrees = (re.findall(rf"([\d.]+){unit} ?\(", told) for unit in (" mm", "°"))
    assert mm or degrees, status
    return max(map(float, mm), default=0.0), max(map(float, degrees), default=0.0)


@pytest.mark.slow
def test_a_generated_rig_lands_further_on_by_keys_on_its_controls() -> None:
    rig = performing(ik=False)
    before = read_recording(rig)
    keyed = land_further(rig)
    after = read_recording(rig)
    assert {"torso", "chest", "thigh_fk.L", "foot_fk.R", "hand_fk.R"} <= keyed
    far, turned = misses(rig.hangtime.status)
    assert far < 0.1
    assert turned < 0.05
    # Feet skate in this take, for the actor has other hips; the landing is held, and further on.
    toe, landed = before.index(TOE), slice(-12, None)
    was, now = before.heads[landed, toe], after.heads[landed, toe]
    assert np.linalg.norm(np.ptp(was, axis=0)) > 0.01
    assert np.ptp(now[:, 1]) < 0.003
    assert (was - now).mean(0) == pytest.approx([0.0, MOVED, 0.0], abs=0.03)


@pytest.mark.slow
def test_feet_and_hands_in_inverse_kinematics_stay_so_and_stand_still_in_their_keys() -> None:
    rig = performing(ik=True)
    keyed = land_further(rig)
    assert {"torso", "foot_ik.L", "foot_ik.R", "thigh_ik.L", "toe_ik.L", "hand_ik.R"} <= keyed
    assert not [bone for bone in keyed if "_fk." in bone and "spine" not in bone]
    far, turned = misses(rig.hangtime.status)
    assert far < 2.0  # of knees, and told: a limb that stretches does so by one size for both bones
    assert turned < 0.2
    assert {row.name for row in rig.hangtime.contacts} >= FLAT
    shown = read_recording(rig)
    for row in (row for row in rig.hangtime.contacts if row.name in FLAT):
        loaded = slice(int(np.ceil(row.start_frame)), int(row.end_frame) - 1)  # from frame 1 on
        drift = carried_places(shown, f"foot_ik.{row.name[0]}", np.array(row.place), loaded)
        assert np.linalg.norm(np.ptp(drift, axis=0)) < 1e-3, row.name


def carried_places(shown: Recording, bone: str, place: np.ndarray, frames: slice) -> np.ndarray:
    """Where a bone carries a place (3,) that it has on the first of some frames."""
    column = shown.index(bone)
    heads, turns = shown.heads[frames, column], shown.rotations[frames, column]
    return heads + turns @ (turns[0].T @ (place - heads[0]))


def moved_take(rig: bpy.types.Object, last: int) -> PoseTrack:
    """The motion of frames 1 to the last, 40 mm higher."""
    take = record(rig, np.arange(1.0, last + 1.0))
    columns = [segment.bone for segment in map_anatomy(take.bones)]
    bodies = tuple(take.bones[column].name for column in columns)
    higher = take.heads[:, columns[0]] + [0.0, 0.0, HIGHER]
    return PoseTrack(take.frames, bodies, take.rotations[:, columns], higher)


def inverted(rig: bpy.types.Object, track: PoseTrack) -> ControlPoses:
    controls = complete(found_controls(rig, track.bones, track.frames))
    return complete(control_poses(controls, sample(rig, track.frames), track))


@pytest.mark.slow
def test_a_switch_between_forward_and_inverse_kinematics_is_followed() -> None:
    rig = generated_human(jumper(), arms=1.0, legs=0.0)
    torso, leg = rig.pose.bones["torso"], rig.pose.bones["thigh_parent.L"]
    for frame, height in ((1, -0.05), (4, -0.2)):
        torso.location.z = height
        torso.keyframe_insert("location", frame=frame)
    for frame, switch in ((1, 0.0), (2, 0.0), (3, 1.0)):
        leg[SWITCH] = switch
        leg.keyframe_insert(f'["{SWITCH}"]', frame=frame)
    posed = inverted(rig, moved_take(rig, 4))
    still, foot, thigh = np.eye(4), posed.bases["foot_ik.L"], posed.bases["thigh_fk.L"]
    assert foot[:2, 2, 3].min() > HIGHER / 2.0
    np.testing.assert_allclose(foot[2:], [still, still], atol=1e-6)
    np.testing.assert_allclose(thigh[:2], [still, still], atol=1e-6)
    assert np.abs(thigh[2:] - still).max() > 1e-3
    assert posed.off[:2].max() < 1e-3


@pytest.mark.slow
def test_what_comes_before_a_switch_is_as_near_and_as_cheap_as_without_it() -> None:
    """Controls that do nothing until it is thrown are none of a rig until then."""
    rig = generated_human(jumper(), arms=1.0, legs=0.0)
    torso, leg = rig.pose.bones["torso"], rig.pose.bones["thigh_parent.L"]
    for frame, height in ((1, -0.05), (8, -0.25), (16, -0.1)):
        torso.location = (0.01 * frame, 0.0, height)
        torso.keyframe_insert("location", frame=frame)
    for frame, switch in ((1, 0.0), (12, 0.0), (13, 1.0)):
        leg[SWITCH] = switch
        leg.keyframe_insert(f'["{SWITCH}"]', frame=frame)
    before, take = moved_take(rig, 12), np.arange(1.0, 17.0)
    whole = complete(found_controls(rig, before.bones, take))
    alone = complete(found_controls(rig, before.bones, before.frames))
    assert {"thigh_fk.L", "shin_fk.L"} <= set(whole.controls) - set(alone.controls)
    poses = sample(rig, before.frames)
    switched, unswitched = (
        complete(control_poses(controls, poses, before)) for controls in (whole, alone)
    )
    assert switched.off.max() < unswitched.off.max() + 1e-4
    assert switched.off.max() < 1e-3
    tried_once = 3 * (len(whole.controls) - len(alone.controls))
    assert switched.tries <= unswitched.tries + tried_once


@pytest.mark.slow
def test_a_rig_made_by_hand_with_feet_and_poles_is_posed_through_these() -> None:
    rig = ik_rig()
    hips, stand = rig.pose.bones["hips"], rig.pose.bones["stand.L"]
    for frame, height in ((1, -0.05), (4, -0.2)):
        hips.location.y = height
        for bone in (hips, stand):
            bone.keyframe_insert("location", frame=frame)
    track = moved_take(rig, 4)
    assert is_driven(rig, track.bones)
    posed = inverted(rig, track)
    assert {"hips", "spine", "stand.L", "stand.R", "knee_pole.R", "hand.L"} <= posed.bases.keys()
    assert not {"thigh.L", "shin.L", "foot.L"} & posed.bases.keys()
    assert posed.off.max() < 1e-4
    assert np.degrees(posed.turned.max()) < 0.05


@pytest.mark.slow
def test_a_figure_that_moves_as_one_takes_its_controls_along_and_turns_none() -> None:
    """Bodies say nothing of how far a pole is away: it stays so as in the take."""
    rig = ik_rig()
    for frame in (1, 4):
        rig.pose.bones["hips"].location.y = -0.05 * frame
        rig.pose.bones["hips"].keyframe_insert("location", frame=frame)
    posed = inverted(rig, moved_take(rig, 4))
    for name in ("knee_pole.L", "knee_pole.R", "stand.L"):
        shifts = np.linalg.norm(posed.bases[name][:, :3, 3], axis=1)
        np.testing.assert_allclose(shifts, HIGHER, atol=1e-5)
    for basis in posed.bases.values():
        np.testing.assert_allclose(basis[:, :3, :3], [np.eye(3)] * 4, atol=1e-5)


@pytest.mark.slow
@pytest.mark.parametrize("turned", [False, True])
def test_a_pole_gets_keys_of_its_turn_only_where_the_take_has_some(turned: bool) -> None:
    rig = ik_rig()
    pole = rig.pose.bones["knee_pole.L"]
    for frame in (1, 4):
        rig.pose.bones["hips"].location.y = -0.05 * frame
        rig.pose.bones["hips"].keyframe_insert("location", frame=frame)
        pole.keyframe_insert("location", frame=frame)
        if turned:
            pole.keyframe_insert("rotation_quaternion", frame=frame)
    track, span = moved_take(rig, 4), (1.0, 4.0)
    motion = AdaptedMotion(track, TimeMap(span, span), None, ResultOptions())
    write_result(rig, motion, name="Result")
    paths = {curve.data_path for curve in curves_of(rig)}
    assert pole.path_from_id("location") in paths
    assert (pole.path_from_id("rotation_quaternion") in paths) == turned


@pytest.mark.slow
@pytest.mark.parametrize("lower", [0.0, 0.002, 0.01])
def test_a_leg_that_was_pulled_straight_is_bent_again(lower: float) -> None:
    """While its foot's control is out of reach no small pull along the leg does anything."""
    rig = ik_rig()
    hips = rig.pose.bones["hips"]
    bent, straight, wanted = -0.1, 0.08, -lower
    for frame, height in enumerate((bent, straight, wanted), start=1):
        hips.location.y = height
        hips.keyframe_insert("location", frame=frame)
    track = moved_take(rig, 3)
    as_wanted = replace(
        track,
        frames=track.frames[:2],
        rotations=track.rotations[[0, 2]],
        root_head=track.root_head[[0, 2]] + [[0.0, 0.0, 0.0], [0.0, 0.0, straight - wanted]],
    )
    posed = inverted(rig, as_wanted)
    assert posed.off.max() < 1e-3


@pytest.mark.parametrize("local", [True, False])
def test_feet_are_carried_along_however_their_locations_count(local: bool) -> None:
    rig = ik_rig()
    for side in "LR":
        rig.data.bones[f"stand.{side}"].use_local_location = local
        rig.pose.bones[f"stand.{side}"].location = (0.02, 0.03, 0.04)
    for name in ("hips", "stand.L"):
        rig.pose.bones[name].keyframe_insert("location", frame=1)
    frames = np.array([1.0])
    before = record(rig, frames)
    columns = [segment.bone for segment in map_anatomy(before.bones)]
    bodies = tuple(before.bones[column].name for column in columns)
    turn, shift = axis_rotation(2, 0.4), np.array([0.5, -0.3, 0.1])
    pelvis = PoseTrack(
        frames,
        bodies[:1],
        turn @ before.rotations[:, columns[:1]],
        before.heads[:, columns[0]] @ turn.T + shift,
    )
    controls = complete(found_controls(rig, bodies, frames))
    bases = complete(carried_controls(controls, sample(rig, frames), pelvis))
    rig.animation_data_clear()
    for name, basis in bases.items():
        rig.pose.bones[name].matrix_basis = Matrix(basis[0].tolist())
    bpy.context.view_layer.update()
    after = np.array([rig.pose.bones[bone.name].head for bone in before.bones])
    np.testing.assert_allclose(after, before.heads[0] @ turn.T + shift, atol=1e-5)


@pytest.mark.slow
def test_controls_are_tried_once_and_anew_where_the_rig_was_changed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    rig, frames = ik_rig(), np.array([1.0])
    rig.pose.bones["hips"].keyframe_insert("location", frame=1)
    before = record(rig, frames)
    bodies = tuple(before.bones[segment.bone].name for segment in map_anatomy(before.bones))
    looks = Counter[str]()
    look = Posing.look

    def counted(posing: Posing) -> Posed:
        looks["all"] += 1
        return look(posing)

    monkeypatch.setattr(Posing, "look", counted)
    found = complete(found_controls(rig, bodies, frames))
    assert "stand.L" in found.controls
    assert "shin.L" not in found.controls
    tried = looks["all"]
    assert tried > len(found.controls)
    assert complete(found_controls(rig, bodies, frames)).controls == found.controls
    assert looks["all"] == tried
    rig.pose.bones["shin.L"].constraints[0].mute = True
    changed = complete(found_controls(rig, bodies, frames))
    assert "shin.L" in changed.controls
    assert "knee_pole.L" not in changed.controls
    rig.pose.bones["shin.L"].constraints[0].mute = False
    for change in (keyed_turn, connected, weaker, moved_pole):
        tried = looks["all"]
        change(rig)
        complete(found_controls(rig, bodies, frames))
        assert looks["all"] > tried, change


def keyed_turn(rig: bpy.types.Object) -> None:
    rig.pose.bones["hips"].keyframe_insert("rotation_quaternion", frame=1)


def connected(rig: bpy.types.Object) -> None:
    bpy.ops.object.mode_set(mode="EDIT")
    rig.data.edit_bones["foot.L"].use_connect = True
    bpy.ops.object.mode_set(mode="OBJECT")


def weaker(rig: bpy.types.Object) -> None:
    rig.pose.bones["shin.L"].constraints[0].influence = 0.3


def moved_pole(rig: bpy.types.Object) -> None:
    rig.pose.bones["knee_pole.L"].location.x = 0.1


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


def test_an_elbow_may_bend_about_any_axis() -> None:
    """One hinge across all of the armature's axes is a lead; none is not, nor what shifts it."""
    oblique = np.zeros((1, 2, 2, 3))  # shifts and turns of trunk and forearm
    oblique[0, 1, 1] = np.ones(3) / np.sqrt(3.0)
    trunk = np.zeros((3, 2, 2, 3))
    trunk[:, 1, 0] = trunk[:, 1, 1] = np.eye(3)
    shifting = oblique.copy()
    shifting[0, 0, 1] = 1.0
    bodies, parents = ("trunk", "forearm"), [-1, 0]

    def unled_by(*dofs: np.ndarray) -> list[str]:
        return unled(LEVER * np.concatenate(dofs).reshape(-1, 12), bodies, parents)

    assert unled_by(trunk, oblique) == []
    assert unled_by(trunk) == unled_by(trunk, shifting) == ["forearm"]


def pulled_legs(jump: bpy.types.Object) -> list[bpy.types.Object]:
    """Lets empties pull the legs of the jump; returns these."""
    targets = []
    for side in ("Left", "Right"):
        target = bpy.data.objects.new(f"{side} target", None)
        bpy.context.scene.collection.objects.link(target)
        chain = jump.pose.bones[f"{side}Leg"].constraints.new("IK")
        chain.target, chain.chain_count = target, 2
        targets.append(target)
    return targets


@pytest.mark.slow
def test_legs_that_are_pulled_from_outside_the_armature_are_refused_before_a_solve(
    jump: bpy.types.Object,
) -> None:
    """Though the bones above them, by which the hips shift, would turn them, too."""
    targets = pulled_legs(jump)
    told = "Constraints .IK. pull LeftLeg, RightLeg towards Left target, Right target"
    with pytest.raises(RuntimeError, match=told):
        bpy.ops.hangtime.analyze()
    for target in targets:
        target.parent = jump
    with pytest.raises(RuntimeError, match=told):
        bpy.ops.hangtime.analyze()
    for target in targets:
        target.parent_type, target.parent_bone = "BONE", "Hips"
    with pytest.raises(RuntimeError, match=r"LeftLeg.* follow constraints, and no bone"):
        bpy.ops.hangtime.analyze()


def test_a_knee_that_turns_towards_what_is_outside_the_armature_is_refused_likewise(
    jump: bpy.types.Object,
) -> None:
    """Alone: what pulls the legs follows a bone."""
    for target in pulled_legs(jump):
        followed = target.constraints.new("ARMATURE").targets.new()
        followed.target, followed.subtarget = jump, "Hips"
    pole = bpy.data.objects.new("Knee", None)
    bpy.context.scene.collection.objects.link(pole)
    jump.pose.bones["LeftLeg"].constraints[0].pole_target = pole
    with pytest.raises(RuntimeError, match="pull LeftLeg towards Knee"):
        bpy.ops.hangtime.analyze()


@pytest.mark.slow
def test_what_pulls_from_outside_at_other_frames_alone_is_no_matter(
    jump: bpy.types.Object,
) -> None:
    pulled_legs(jump)
    for side in ("Left", "Right"):
        chain = jump.pose.bones[f"{side}Leg"].constraints[0]
        for frame, influence in ((1, 1.0), (JUMP_FRAMES[0] - 40, 1.0), (JUMP_FRAMES[0] - 30, 0.0)):
            chain.influence = influence
            chain.keyframe_insert("influence", frame=frame)
    settings = jump.hangtime
    settings.use_range, (settings.first_frame, settings.last_frame) = True, JUMP_FRAMES
    assert bpy.ops.hangtime.analyze() == {"FINISHED"}


@pytest.mark.slow
def test_a_constraint_on_a_finger_diverts_nothing(jump: bpy.types.Object) -> None:
    finger = jump.pose.bones["LeftHandIndex1"].constraints.new("COPY_ROTATION")
    finger.target, finger.subtarget = jump, "RightHandIndex1"
    thigh = jump.pose.bones["LeftUpLeg"].constraints.new("LIMIT_ROTATION")
    thigh.use_limit_y, thigh.min_y, thigh.max_y = True, -np.pi, np.pi  # bends no pose of the jump
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


def test_of_controls_that_do_nothing_that_hangs_together_none_is_needed() -> None:
    """Found by the campaign (seed 3, case 5255). One stretches two bones, wherever these are."""
    wanted = np.eye(12)[:9]
    apart = np.eye(12)[9:10]
    assert needed([[0]], [Effects(apart, wanted)]) == []
    assert needed([[0]], [Effects(wanted[:1], wanted)]) == [0]
