"""Changed bodies: lengths and masses as asked, composite inertia and dynamics as MuJoCo's."""

from dataclasses import replace
from functools import cache
from xml.etree import ElementTree as ET

import hypothesis.strategies as st
import mujoco
import numpy as np
import pytest
from hangtime.devtools.checks.mjcf import hinge_order, mjcf, state
from hangtime.devtools.checks.mujoco_check import inverse_dynamics, root_wrench
from hangtime.solver.analysis.performance import perform
from hangtime.solver.arrays import FloatArray
from hangtime.solver.body.anatomy import Part, Side
from hangtime.solver.body.body_changes import changed_character, changed_points
from hangtime.solver.body.body_shapes import stretched, with_ball
from hangtime.solver.body.character import Character, build_character
from hangtime.solver.body.dynamics import MomentFunction
from hangtime.solver.body.inverse_dynamics import InverseDynamics
from hangtime.solver.body.kinematics import BodyPoint, forward_kinematics
from hangtime.solver.body.mass_tables import BODY_DENSITY
from hangtime.solver.body.proportions import changed_recording
from hangtime.solver.data.constants import STANDARD_GRAVITY
from hangtime.solver.data.faults import NotAboveZero, UnknownBone
from hangtime.solver.data.problem import MassTable
from hangtime.solver.data.recording import Recording
from hangtime.solver.data.requests import AddedMass, BodyChange, LimbChange
from hangtime.solver.inverse_kinematics.reseat import reseat
from hangtime.solver.results.npz_export import sample
from hangtime.solver.transcription.motion import Motion, dynamics_residual
from hangtime.tests.helpers import toy_problems as toys
from hangtime.tests.helpers.clips import load_recording
from hypothesis import given, settings

JUMP = "forward_jump_116cm.bvh"
LEGS = ("LeftUpLeg", "LeftLeg", "RightUpLeg", "RightLeg")
SPINE = ("LowerBack", "Spine", "Spine1")
CASE = AddedMass("Briefcase", "RightHand", share=0.2)
MOON = 1.62
INSTANTS = 6


@cache
def recording() -> Recording:
    return load_recording(JUMP).window(73.0, 133.0)


@cache
def figure(table: MassTable = MassTable.THESIS) -> Character:
    return build_character(recording(), table=table)


def changed(change: BodyChange, table: MassTable = MassTable.THESIS) -> Character:
    new = changed_recording(recording(), change.limbs)
    return changed_character(figure(table), change, recording(), new)


ALL = BodyChange(
    mass=80.0,
    gravity=MOON,
    added=(CASE, AddedMass("Ring", "LThumb", mass=0.4, offset=(0.02, -0.03, 0.01))),
    limbs=(LimbChange("Long legs", LEGS, 1.3, 0.9), LimbChange("Torso", SPINE, 0.7)),
)


# -- lengths -------------------------------------------------------------------------------


def test_factors_of_one_change_nothing() -> None:
    limbs = (LimbChange("Same", (*LEGS, *SPINE, "Head", "LeftHand")),)
    same = changed_recording(recording(), limbs)
    np.testing.assert_array_equal(same.heads, recording().heads)
    for bone, was in zip(same.bones, recording().bones, strict=True):
        np.testing.assert_array_equal(bone.head, was.head)
        np.testing.assert_array_equal(bone.tail, was.tail)
    made = changed(BodyChange(limbs=limbs))
    for body, old in zip(made.bodies, figure().bodies, strict=True):
        for field in ("mass", "com", "inertia", "tip", "box_size", "box_rotation", "box_centre"):
            np.testing.assert_array_equal(getattr(body, field), getattr(old, field))
    for joint, before in zip(made.joints, figure().joints, strict=True):
        np.testing.assert_array_equal(joint.offset, before.offset)
    assert made.height == figure().height
    assert made.gravity == STANDARD_GRAVITY


def test_twice_the_length_moves_all_below_along_the_bone() -> None:
    limbs = (LimbChange("Twice", ("LeftUpLeg",), 2.0),)
    new = changed_recording(recording(), limbs)
    thigh = recording().index("LeftUpLeg")
    old = recording().bones[thigh]
    span = old.tail - old.head
    below = {thigh}
    for b, bone in enumerate(recording().bones):
        shift = span if bone.parent in below else np.zeros(3)
        if bone.parent in below:
            below.add(b)
        grown = span if b in below else np.zeros(3)
        np.testing.assert_allclose(new.bones[b].head, bone.head + shift, atol=1e-12)
        np.testing.assert_allclose(new.bones[b].tail, bone.tail + grown, atol=1e-12)
        carried = recording().rotations[:, thigh] @ old.rotation.T @ shift
        np.testing.assert_allclose(new.heads[:, b], recording().heads[:, b] + carried, atol=1e-12)
    assert len(below) > 3
    np.testing.assert_array_equal(new.rotations, recording().rotations)


def test_factors_of_several_changes_multiply() -> None:
    both = changed_recording(
        recording(), (LimbChange("A", LEGS, 1.2), LimbChange("B", ("LeftLeg",), 0.5))
    )
    for name, factor in (("LeftLeg", 0.6), ("RightLeg", 1.2), ("LeftFoot", 1.0)):
        was, now = (each.bones[each.index(name)] for each in (recording(), both))
        lengths = [np.linalg.norm(bone.tail - bone.head) for bone in (was, now)]
        np.testing.assert_allclose(lengths[1], factor * lengths[0])


@pytest.mark.parametrize("table", list(MassTable))
def test_a_changed_figure_has_the_lengths_of_one_built_anew(table: MassTable) -> None:
    """The old axes hold the old angles; only leaves' lengths are not clipped again."""
    limbs = (LimbChange("Legs", LEGS, 1.3), LimbChange("Arms", ("LeftArm", "LeftForeArm"), 0.8))
    new = changed_recording(recording(), limbs)
    made, built = changed(BodyChange(limbs=limbs), table), build_character(new, table=table)
    for ours, theirs in zip(made.joints, built.joints, strict=True):
        np.testing.assert_allclose(ours.offset, theirs.offset, atol=1e-9)
    for body, other, old in zip(made.bodies, built.bodies, figure(table).bodies, strict=True):
        if body.bone in limbs[0].bones + limbs[1].bones:
            np.testing.assert_allclose(body.tip, other.tip, atol=1e-9)
            np.testing.assert_allclose(body.com, other.com, atol=1e-9)
            np.testing.assert_allclose(body.box_size[2], other.box_size[2])
            np.testing.assert_array_equal(body.box_size[:2], old.box_size[:2])
        assert body.mass == old.mass
    np.testing.assert_allclose(made.height, built.height)
    np.testing.assert_allclose(
        perform(new, made).angles, perform(recording(), figure(table)).angles, atol=1e-12
    )


def test_the_changed_figure_stands_where_the_changed_recording_does() -> None:
    limbs = (LimbChange("Legs", LEGS, 1.3), LimbChange("Torso", SPINE, 0.7))
    new, made = changed_recording(recording(), limbs), changed(BodyChange(limbs=limbs))
    before, after = (
        perform(*each).centres
        - forward_kinematics(each[1], perform(*each).angles).centres
        - com[:, None]
        for each, com in (
            ((recording(), figure()), perform(recording(), figure()).com),
            ((new, made), perform(new, made).com),
        )
    )
    # Joints of few angles miss the recording by a little, over longer legs by a little more.
    assert np.abs(after).max() < 1.5 * np.abs(before).max() + 1e-6


# -- masses --------------------------------------------------------------------------------


@given(
    factor=st.floats(0.3, 3.0),
    size=st.tuples(*[st.floats(0.1, 0.5)] * 3),
    mass=st.floats(0.1, 20.0),
)
def test_a_stretched_box_is_a_box(factor: float, size: tuple[float, ...], mass: float) -> None:
    body = toys.body("limb", Part.THIGH, Side.LEFT, mass, (0.0, 0.0, -size[2]))
    long = toys.body("limb", Part.THIGH, Side.LEFT, mass, (0.0, 0.0, -factor * size[2]))
    made = stretched(body, long.tip)
    np.testing.assert_allclose(made.inertia, long.inertia, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(made.com, long.com)
    np.testing.assert_allclose(made.box_size, long.box_size)
    np.testing.assert_allclose(made.box_centre, long.box_centre)
    assert made.mass == mass


def test_published_radii_along_a_limb_keep_their_share_of_its_length() -> None:
    limbs = (LimbChange("Legs", LEGS, 1.5),)
    made, old = changed(BodyChange(limbs=limbs), MassTable.DE_LEVA), figure(MassTable.DE_LEVA)
    shank = next(i for i, body in enumerate(old.bodies) if body.bone == "LeftLeg")
    across, along = [], []
    for body in (old.bodies[shank], made.bodies[shank]):
        turned = np.diagonal(body.box_rotation.T @ body.inertia @ body.box_rotation) / body.mass
        across.append(turned[2])
        along.append(0.5 * (turned[0] + turned[1] - turned[2]))  # second moment along the limb
    np.testing.assert_allclose(across[1], across[0], rtol=1e-9)
    np.testing.assert_allclose(along[1], 1.5**2 * along[0], rtol=1e-9)


def test_masses_are_as_asked() -> None:
    total = 80.0 * 1.2 + 0.4
    np.testing.assert_allclose(changed(ALL).mass, total)
    heavy = changed(BodyChange(limbs=(LimbChange("Heavy", ("LeftLeg", "LThumb"), mass=2.0),)))
    for body, old in zip(heavy.bodies, figure().bodies, strict=True):
        factor = 2.0 if body.bone == "LeftLeg" else 1.0
        np.testing.assert_allclose(body.mass, factor * old.mass)
        np.testing.assert_allclose(body.inertia, factor * old.inertia)
    assert changed(ALL).gravity == MOON


def test_a_mass_is_carried_where_it_was_asked() -> None:
    made = changed(BodyChange(added=(CASE,)))
    bone = recording().bones[recording().index("RightHand")]
    hand = next(i for i, body in enumerate(made.bodies) if body.bone == "RightHand")
    old, new = figure().bodies[hand], made.bodies[hand]
    np.testing.assert_allclose(new.mass - old.mass, 14.0)
    place = (new.mass * new.com - old.mass * old.com) / 14.0
    np.testing.assert_allclose(place, bone.tail - bone.head, atol=1e-12)
    others = [i for i in range(len(made.bodies)) if i != hand]
    assert all(made.bodies[i].mass == figure().bodies[i].mass for i in others)


def test_what_a_bone_without_a_body_carries_goes_to_the_nearest_body() -> None:
    ring = AddedMass("Ring", "LThumb", mass=0.4, offset=(0.02, -0.03, 0.01))
    made = changed(BodyChange(added=(ring,)))
    thumb = recording().bones[recording().index("LThumb")]
    hand = next(i for i, body in enumerate(made.bodies) if body.bone == "LeftHand")
    old, new = figure().bodies[hand], made.bodies[hand]
    place = (new.mass * new.com - old.mass * old.com) / 0.4
    head = recording().bones[recording().index("LeftHand")].head
    expected = thumb.head + thumb.rotation @ np.array(ring.offset) - head
    np.testing.assert_allclose(place, expected, atol=1e-12)


@pytest.mark.parametrize(
    ("change", "fault"),
    [
        (BodyChange(limbs=(LimbChange("Tail", ("Tail",), 2.0),)), UnknownBone("Tail", "Tail")),
        (BodyChange(added=(AddedMass("Bag", "Wing", 1.0),)), UnknownBone("Bag", "Wing")),
        (BodyChange(added=(AddedMass("Bag", "Head"),)), NotAboveZero("Bag", 0.0)),
        (BodyChange(limbs=(LimbChange("No legs", LEGS, 0.0),)), NotAboveZero("No legs", 0.0)),
        (BodyChange(limbs=(LimbChange("Air", LEGS, mass=-1.0),)), NotAboveZero("Air", -1.0)),
        (BodyChange(mass=0.0), NotAboveZero("body", 0.0)),
    ],
)
def test_what_cannot_be_is_named(change: BodyChange, fault: Exception) -> None:
    with pytest.raises(type(fault)) as caught:
        changed(change)
    assert caught.value == fault


# -- MuJoCo's opinion ----------------------------------------------------------------------


def random_state(character: Character, seed: int) -> tuple[list[FloatArray], list[FloatArray]]:
    """Centre of mass and angles, each with two derivatives."""
    random = np.random.default_rng(seed)
    n = character.n_angles
    angles = [scale * random.normal(size=(INSTANTS, n)) for scale in (1.0, 4.0, 30.0)]
    return [random.normal(size=(INSTANTS, 3)) for _ in range(3)], angles


def relative(ours: FloatArray, theirs: FloatArray) -> float:
    return float(np.abs(ours - theirs).max() / np.abs(theirs).max())


@pytest.mark.parametrize("table", list(MassTable))
@pytest.mark.parametrize("gravity", [STANDARD_GRAVITY, MOON])
def test_inverse_dynamics_of_a_changed_figure_is_mujocos(gravity: float, table: MassTable) -> None:
    character = changed(replace(ALL, gravity=gravity), table)
    points = tuple(BodyPoint(i, character.bodies[i].tip) for i in (3, 7))
    com, angles = random_state(character, 5)
    forces = 300.0 * np.random.default_rng(6).normal(size=(INSTANTS, 2, 3))
    model = mujoco.MjModel.from_xml_string(mjcf(character, points))
    model.body_sameframe[:] = 0  # else MuJoCo leaves out turns of the inertia below 1e-6 rad
    assert model.opt.gravity[2] == -gravity
    made = state(character, com, angles)
    theirs, _ = inverse_dynamics(model, made, forces)
    force, moment = root_wrench(made[0], theirs, com[0])
    q, v, a = angles
    ours = InverseDynamics(character, points)(q, v, a, com[2], forces)
    assert relative(ours.root_force, force) < 1e-9
    assert relative(ours.root_moment, moment) < 1e-9
    order = hinge_order(character) - 3
    assert relative(ours.torques[:, order], theirs[:, 6:]) < 1e-9


@settings(max_examples=20)
@given(
    mass=st.floats(0.05, 30.0),
    place=st.tuples(*[st.floats(-0.5, 0.5)] * 3),
    which=st.integers(0, 9),
)
@pytest.mark.slow
def test_composite_inertia_is_mujocos(
    mass: float, place: tuple[float, float, float], which: int
) -> None:
    """A ball welded to the body by MuJoCo moves the figure like the one joined by us."""
    character = figure()
    where = which % len(character.bodies)
    bodies = list(character.bodies)
    bodies[where] = with_ball(bodies[where], mass, np.array(place))
    ours = mujoco.MjModel.from_xml_string(mjcf(replace(character, bodies=tuple(bodies))))
    theirs = mujoco.MjModel.from_xml_string(welded(character, where, mass, np.array(place)))
    com, angles = random_state(character, 11)
    qpos, qvel, qacc = state(character, com, angles)
    none = np.zeros((INSTANTS, 0, 3))
    one, centre = inverse_dynamics(ours, (qpos, qvel, qacc), none)
    other, other_centre = inverse_dynamics(theirs, (qpos, qvel, qacc), none)
    assert relative(one, other) < 1e-9
    np.testing.assert_allclose(centre, other_centre, atol=1e-12)


def welded(character: Character, body: int, mass: float, place: FloatArray) -> str:
    """The figure's MJCF with a ball as a body of its own, without a joint."""
    root = ET.fromstring(mjcf(character))
    name = f"{body} {character.bodies[body].name}"
    home = next(each for each in root.iter("body") if each.get("name") == name)
    fold = character.joints[body].axes.after if body > 0 else np.eye(3)
    ball = ET.SubElement(
        home, "body", name="ball", pos=" ".join(map(repr, (fold @ place).tolist()))
    )
    radius = (0.75 * mass / (np.pi * BODY_DENSITY)) ** (1 / 3)
    inertia = " ".join([repr(0.4 * mass * radius**2)] * 3)
    ET.SubElement(ball, "inertial", pos="0 0 0", mass=repr(mass), diaginertia=inertia)
    return ET.tostring(root, encoding="unicode")


# -- a motion of the old figure ------------------------------------------------------------


def toy_motion() -> Motion:
    t = toys.standing()
    return Motion(t, toys.random_state(3, 0.02), toys.places())


def long_legged(factor: float, gravity: float = STANDARD_GRAVITY) -> Character:
    """The toy with longer legs."""
    old = toys.figure()
    bodies = [
        body if i == 0 else stretched(body, factor * body.tip) for i, body in enumerate(old.bodies)
    ]
    joints = [
        joint if joint.parent <= 0 else replace(joint, offset=factor * joint.offset)
        for joint in old.joints
    ]
    return Character(tuple(bodies), tuple(joints), old.height, gravity)


def moved_to(motion: Motion, character: Character) -> Motion:
    t = motion.transcription
    points = changed_points(t.points, t.character, character)
    new = replace(t, character=character, points=points, moment=MomentFunction(character))
    return Motion(new, reseat(motion, character), motion.places)


def test_the_same_figure_keeps_its_seat() -> None:
    motion = toy_motion()
    np.testing.assert_array_equal(reseat(motion, toys.figure()), motion.x)


def test_contact_points_stay_on_average() -> None:
    motion = toy_motion()
    made = moved_to(motion, long_legged(1.3))
    layout = motion.transcription.layout
    np.testing.assert_array_equal(made.x[:, layout.angles], motion.x[:, layout.angles])
    np.testing.assert_array_equal(made.x[:, layout.forces], motion.x[:, layout.forces])
    both = np.linspace(0.0, toys.LIFT - 0.03, 20)
    alone = np.linspace(toys.LIFT + 0.03, toys.DURATION, 20)
    # The spline rounds off the step from the mean of both feet to the left one.
    before, after = (each.contact_points(both).mean(axis=1) for each in (motion, made))
    np.testing.assert_allclose(after, before, atol=0.005)
    one, other = (each.contact_points(alone)[:, 0] for each in (motion, made))
    np.testing.assert_allclose(other, one, atol=0.005)
    risen = made.joint_centres(both)[:, 0, 2] - motion.joint_centres(both)[:, 0, 2]
    assert risen.min() > 0.2  # m; legs of 0.95 m grew by 0.3


def test_on_the_moon_vertical_forces_shrink_with_gravity() -> None:
    motion = toy_motion()
    made = moved_to(motion, long_legged(1.0, MOON))
    times = np.linspace(0.01, 0.29, 15)
    before, after = motion.forces(times), made.forces(times)
    np.testing.assert_allclose(after[..., 2], MOON / STANDARD_GRAVITY * before[..., 2], atol=1e-9)
    np.testing.assert_allclose(after[..., :2], before[..., :2], atol=1e-9)
    # What a resting centre of mass leaves unexplained is then the accelerations' share alone.
    left = (
        dynamics_residual(made, times).force * STANDARD_GRAVITY * made.transcription.character.mass
    )
    fall = made.com(times, 2) + np.array([0.0, 0.0, MOON])
    expected = made.transcription.character.mass * fall - after.sum(axis=1)
    np.testing.assert_allclose(left, expected, atol=1e-8)
    assert sample(made)["gravity"].tolist() == [0.0, 0.0, -MOON]


def test_points_of_a_longer_foot_move_with_its_end() -> None:
    old, new = toys.figure(), long_legged(1.5)
    shank = 2
    points = [BodyPoint(shank, share * old.bodies[shank].tip) for share in (-0.1, 0.0, 0.5, 1.0)]
    made = changed_points(points, old, new)
    for point, share in zip(made, (-0.1, 0.0, 0.75, 1.5), strict=True):
        np.testing.assert_allclose(point.place, share * old.bodies[shank].tip, atol=1e-12)
