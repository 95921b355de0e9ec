"""Where the viewport's overlays show things, in scenes of any scale, without a window."""

from __future__ import annotations

import json
from dataclasses import astuple, replace

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.bridge.armature.traces_store import keep
from hangtime.bridge.constraint_kinds import KINDS
from hangtime.bridge.properties.of_actions.shown_overlaps import ShownOverlap
from hangtime.bridge.rows.choices import Span
from hangtime.tests.blender.helpers.overlays import (
    FIGURE,
    FRAME,
    METRES,
    THICK,
    WHERE,
    adapted,
    bone_in_world,
    constrain,
    in_world,
    seen,
    shown,
    traced,
    words,
)
from hangtime.ui.overlay.context.layer import Layer, Part
from hangtime.ui.overlay.geometry.shapes import Look, Shape
from hangtime.ui.overlay.layers import motion, pins
from mathutils import Euler, Matrix, Quaternion, Vector

TOLERANCE = 1e-4

pytestmark = pytest.mark.usefixtures("_enabled")


@pytest.fixture(params=WHERE)
def armature(request: pytest.FixtureRequest) -> bpy.types.Object:
    return adapted(WHERE[request.param])


def angles_to(points: np.ndarray, apex: np.ndarray, axis: np.ndarray) -> np.ndarray:
    arms = points - apex
    along = arms @ axis / np.linalg.norm(axis)
    return np.arccos(along / np.linalg.norm(arms, axis=1))


def test_a_cone_opens_about_its_own_axis_from_the_joint(armature: bpy.types.Object) -> None:
    """At rest a bone's own direction is an axis that its cone holds."""
    rest(armature)
    head, tail = bone_in_world(armature, "shin")
    axis = tail - head
    constrain(armature, KINDS["CONE"], "shin", half_angle=0.6, use_axis=True, axis=axis)
    rim = in_world(shown(armature)[Part.LIMITS], Look.BOLD)
    np.testing.assert_allclose(angles_to(rim, head, axis), 0.6, atol=1e-3)
    np.testing.assert_allclose(
        np.linalg.norm(rim - head, axis=1), np.linalg.norm(axis), rtol=TOLERANCE
    )


def test_a_cone_without_an_axis_is_about_the_recording_at_that_frame(
    armature: bpy.types.Object,
) -> None:
    """In one frame the mean direction is the bone's own; the hips' turn is known exactly."""
    row = constrain(armature, KINDS["CONE"], "thigh", half_angle=0.3, span=Span.FRAME.name)
    row.first_frame = FRAME
    head, _ = bone_in_world(armature, "thigh")
    knee, _ = bone_in_world(armature, "shin")
    rim = in_world(shown(armature)[Part.LIMITS], Look.BOLD)
    np.testing.assert_allclose(angles_to(rim, head, knee - head), 0.3, atol=2e-3)


def test_a_cone_moves_with_the_parent(armature: bpy.types.Object) -> None:
    constrain(armature, KINDS["CONE"], "shin", half_angle=0.5)
    before = in_world(shown(armature)[Part.LIMITS], Look.BOLD)
    head, _ = bone_in_world(armature, "shin")
    armature.animation_data_clear()
    thigh = armature.pose.bones["thigh"]
    thigh.rotation_quaternion = Euler((0.5, 0.2, 0.1)).to_quaternion() @ thigh.rotation_quaternion
    bpy.context.view_layer.update()
    after = in_world(shown(armature)[Part.LIMITS], Look.BOLD)
    moved, _ = bone_in_world(armature, "shin")
    assert np.abs(after - before).max() > 0.01
    np.testing.assert_allclose(
        np.linalg.norm(after - moved, axis=1), np.linalg.norm(before - head, axis=1), rtol=1e-3
    )


@pytest.mark.parametrize("bend", [0.4, 1.2])
def test_a_joint_says_how_it_is_bent_and_how_it_is_limited(
    armature: bpy.types.Object, bend: float
) -> None:
    """The arc's ends lie at the limits, counted from the straight limb."""
    rest(armature)
    constrain(armature, KINDS["ANGLE"], "shin", lower=0.2, upper=0.8)
    said = []
    for way in (bend, -bend):
        straighten_and_bend(armature, "shin", way)
        layer = shown(armature)[Part.LIMITS]
        hip, _ = bone_in_world(armature, "thigh")
        knee, end = bone_in_world(armature, "shin")
        ends = in_world(layer, Look.BOLD)
        spokes = ends[np.linalg.norm(ends - knee, axis=1) > 1e-3]
        found = angles_to(spokes[:2], knee, knee - hip)
        np.testing.assert_allclose(np.sort(found), (0.2, 0.8), atol=0.01)
        assert np.isclose(angles_to(end[None], knee, knee - hip)[0], bend, atol=0.01)
        said += words(layer)
    degrees = f"{np.degrees(bend):.0f}°"
    assert set(said) == {degrees, f"-{degrees}"}  # which way it bends, the recording says


def rest(armature: bpy.types.Object) -> None:
    """Poses it as at rest, for good."""
    armature.animation_data_clear()
    for bone in armature.pose.bones:
        bone.matrix_basis.identity()
    bpy.context.view_layer.update()


def straighten_and_bend(armature: bpy.types.Object, name: str, bend: float) -> None:
    """Poses a bone so that it leaves its parent's line by this angle."""
    bone = armature.pose.bones[name]
    straight = (bone.head - bone.parent.head).normalized()
    across = straight.cross(Vector((1.0, 0.0, 0.0))).normalized()
    axis = straight.cross(across)
    wanted = Matrix.Rotation(bend, 3, axis) @ straight
    turn = (bone.tail - bone.head).rotation_difference(wanted).to_matrix().to_4x4()
    head = Matrix.Translation(bone.head)
    bone.matrix = head @ turn @ head.inverted() @ bone.matrix
    bpy.context.view_layer.update()


@pytest.mark.parametrize("twist", [-1.0, 0.0, 2.0])
def test_a_twist_is_told_apart_from_the_swing(armature: bpy.types.Object, twist: float) -> None:
    rest(armature)
    foot = armature.pose.bones["foot"]
    swing = Quaternion((0.6, 0.0, -0.8), 0.5)  # a bone's own axis is y
    foot.rotation_quaternion = swing @ Quaternion((0.0, 1.0, 0.0), twist)
    bpy.context.view_layer.update()
    constrain(armature, KINDS["TWIST"], "foot", lower=-0.5, upper=0.5)
    layer = shown(armature)[Part.LIMITS]
    assert words(layer) == [f"{np.degrees(twist):.0f}°"]
    head, tail = bone_in_world(armature, "foot")
    rim = in_world(layer, Look.GLASS)
    assert np.ptp((rim - head) @ (tail - head)) < TOLERANCE * np.linalg.norm(tail - head) ** 2


def test_pins_are_where_contacts_shall_be(armature: bpy.types.Object) -> None:
    row = armature.hangtime.contacts[0]
    row.at = (40.0, 50.0, 6.0)
    layer = shown(armature)[Part.CONTACTS]
    balls = in_world(layer, Look.SOLID)
    away = np.linalg.norm(balls - np.array(row.at), axis=1)
    radius = away.min()
    assert np.isclose(radius, 0.022 * 1.4 / METRES, rtol=0.01)  # a moved one is larger
    line = in_world(layer, Look.THIN)
    for end in (row.at, row.found_at):
        assert np.linalg.norm(line - np.array(end), axis=1).min() < 2.0


def test_a_held_point_is_hollow_unless_something_pushes_back(armature: bpy.types.Object) -> None:
    row = constrain(armature, KINDS["POINT"], "foot")
    assert looks(shown(armature)[Part.POINTS]) == {Look.BOLD, Look.THIN}
    row.environment = True
    assert looks(shown(armature)[Part.POINTS]) == {Look.SOLID, Look.THIN}


def looks(layer: Layer) -> set[Look]:
    return {s.look for s in layer.build() if isinstance(s, Shape) and len(s.points)}


def test_a_point_without_a_place_is_where_the_recording_has_it(armature: bpy.types.Object) -> None:
    constrain(armature, KINDS["POINT"], "thigh")
    head, _ = bone_in_world(armature, "thigh")
    knee, _ = bone_in_world(armature, "shin")
    rings = in_world(shown(armature)[Part.POINTS], Look.BOLD)
    np.testing.assert_allclose(rings.mean(axis=0), 0.5 * (head + knee), atol=0.05)


def test_bounds_without_a_place_count_from_the_floor(armature: bpy.types.Object) -> None:
    armature.hangtime.contacts[0].found_at = (0.0, 0.0, 7.0)
    armature.hangtime.contacts[1].found_at = (0.0, 0.0, 9.0)
    row = constrain(armature, KINDS["POINT"], "foot", use_bounds=True)
    row.bound_axes, row.at_least, row.at_most = (False, False, True), (0, 0, 30), (0, 0, 50)
    box = pins.points(seen(armature))
    heights = in_world(box, Look.THIN)[:, 2]
    assert {37.0, 57.0} <= set(np.round(heights, 3))


@pytest.mark.parametrize("part", [Part.RECORDED_GHOSTS, Part.ADAPTED_GHOSTS])
def test_ghosts_stand_where_the_motion_was(armature: bpy.types.Object, part: Part) -> None:
    """And follow the armature when it is moved afterwards."""
    view = bpy.context.scene.hangtime.view
    view.ghost_step = 100  # the first frame alone
    bpy.context.scene.frame_set(1)
    shift = np.array((1.0 / METRES, 0.0, 0.0)) if part is Part.ADAPTED_GHOSTS else np.zeros(3)
    for _ in range(2):
        ghost = in_world(shown(armature)[part])
        for bone in FIGURE:
            head, _ = bone_in_world(armature, bone)
            there = np.array(moved_by(armature) @ Vector(shift)) + head
            assert np.linalg.norm(ghost - there, axis=1).min() < 0.01 * armature.scale[0]
        armature.matrix_world = Matrix.Translation((5.0, 6.0, 7.0)) @ armature.matrix_world
        armature.rotation_euler.z += 0.7
        bpy.context.view_layer.update()


def moved_by(armature: bpy.types.Object) -> Matrix:
    """The turn by which an armature was turned since it was made."""
    at_first = next(
        m for m in WHERE.values() if np.isclose(m.median_scale, armature.matrix_world.median_scale)
    )
    return (armature.matrix_world @ at_first.inverted()).to_3x3()


def test_forces_are_arrows_as_long_as_they_are_strong(armature: bpy.types.Object) -> None:
    layer = shown(armature)[Part.FORCES]
    arrow = in_world(layer) - in_world(layer).min(axis=0)
    assert np.isclose(arrow[:, 2].max(), 2.0 * motion.PER_WEIGHT / METRES, rtol=1e-3)
    assert words(layer) == ["2.0 body weights"]
    assert looks(shown(armature, 14.0)[Part.FORCES]) == set()
    assert list(shown(armature, 500.0)[Part.FORCES].build()) == []


def test_solid_shapes_are_round_their_bones_and_red_where_one_is_in_something(
    armature: bpy.types.Object,
) -> None:
    view = bpy.context.scene.hangtime.view
    assert Part.SHAPES not in shown(armature)
    view.shapes = True
    recorded = ShownOverlap("Head in shin", 21.4, FRAME)
    armature.hangtime.adapted.hangtime.overlaps = json.dumps([[astuple(recorded)], []])
    layer = shown(armature)[Part.SHAPES]
    for bone in FIGURE:
        head, _ = bone_in_world(armature, bone)
        assert np.linalg.norm(in_world(layer) - head, axis=1).min() < 1.01 * THICK / METRES
    red = in_world(layer, Look.BOLD)
    for bone in ("head", "shin"):
        head, _ = bone_in_world(armature, bone)
        assert np.linalg.norm(red - head, axis=1).min() < 1.01 * THICK / METRES
    assert words(layer) == ["Head in shin 21 mm"]
    assert words(shown(armature, FRAME + 4.0)[Part.SHAPES]) == []


def test_shapes_of_the_result_have_its_own_overlaps(armature: bpy.types.Object) -> None:
    bpy.context.scene.hangtime.view.shapes = True
    after = ShownOverlap("Foot in Crate", 7.0, FRAME)
    armature.hangtime.adapted.hangtime.overlaps = json.dumps([[], [astuple(after)]])
    assert words(shown(armature)[Part.SHAPES]) == []
    armature.animation_data.action = armature.hangtime.adapted
    assert words(shown(armature)[Part.SHAPES]) == ["Foot in Crate 7 mm"]


def test_the_path_is_a_line_on_the_ground_and_a_parabola_in_flight(
    armature: bpy.types.Object,
) -> None:
    kept = seen(armature).adapted
    assert kept is not None
    assert motion.on_ground(kept.traces) == [(-np.inf, 12.0), (18.0, np.inf)]
    dashes = [s for s in shown(armature)[Part.ADAPTED_PATH].build() if isinstance(s, Shape)]
    assert len(dashes) == 3
    assert len({tuple(shape.colours[0]) for shape in dashes}) == 2


def test_the_path_of_a_long_take_keeps_its_bends(armature: bpy.types.Object) -> None:
    frames = np.arange(2753.0)  # 23 s of hops, 0.2 m up and down, at 120 frames a second
    com = np.stack([0.01 * frames, 0.0 * frames, 0.2 * np.sin(frames * np.pi / 90.0)], axis=1)
    take = replace(traced(armature), frames=frames, com=com, flights=())
    (line,) = motion.path_shapes(take, (1.0, 1.0, 1.0, 1.0), 1.0)
    drawn = np.interp(com[:, 0], line.points[:, 0], line.points[:, 2])
    np.testing.assert_allclose(drawn, com[:, 2], atol=0.005)


def test_a_pose_is_hung_where_the_figure_is(armature: bpy.types.Object) -> None:
    """The pose of the same frame is the figure itself."""
    armature.hangtime.adapted = None
    row = constrain(armature, KINDS["POSE"], span=Span.FRAME.name, first_frame=FRAME)
    body = in_world(shown(armature)[Part.POSES])
    for bone in FIGURE:
        head, _ = bone_in_world(armature, bone)
        assert np.linalg.norm(body - head, axis=1).min() < 0.01 * armature.scale[0]
    row.use_pose_frame, row.pose_frame = True, 20.0
    other = in_world(shown(armature)[Part.POSES])
    hips, _ = bone_in_world(armature, "hips")
    assert np.linalg.norm(other - hips, axis=1).min() < 0.01 * armature.scale[0]
    assert np.abs(other - body).max() > 0.05


def test_limbs_tell_by_colour_how_far_their_joints_are_turned(armature: bpy.types.Object) -> None:
    bpy.context.scene.hangtime.view.changes = True
    traces = traced(armature, adapted=True)
    turned = np.zeros(traces.heads.shape[:2])
    turned[:, 1] = np.radians(50.0)
    keep(armature.hangtime.adapted, replace(traces, changes=turned), armature.matrix_world)
    layer = shown(armature)[Part.CHANGES]
    assert words(layer) == ["50°"]
    (bodies,) = [s for s in layer.build() if isinstance(s, Shape)]
    red, *_, blue = np.split(bodies.colours, len(FIGURE))[1::-1]
    assert red[:, 0].max() > red[:, 2].max()
    assert blue[:, 2].max() > blue[:, 0].max()


def test_a_motion_stored_without_its_changes_shows_none(armature: bpy.types.Object) -> None:
    bpy.context.scene.hangtime.view.changes = True
    assert list(shown(armature)[Part.CHANGES].build()) == []
