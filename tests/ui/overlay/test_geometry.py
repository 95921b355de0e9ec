"""Shapes of the viewport's overlays and the poses of joints, without Blender."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from hangtime.bridge.shapes.limits import cone_rim
from hangtime.solver.body.human_limits import edge
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.ui.overlay.geometry import arcs, shapes, solids, wires
from hangtime.ui.overlay.geometry.body_rotations import TracedFigure, body_turns, posed, shortest
from hangtime.ui.overlay.geometry.limit_poses import Joints, bends, cones, twists
from hangtime.ui.overlay.geometry.shapes import Look, Shape

RED = (1.0, 0.0, 0.0, 1.0)
X, Y, Z = np.eye(3)
TURN = axis_rotation(2, 0.7) @ axis_rotation(0, -1.1) @ axis_rotation(1, 0.4)
PARENTS = (-1, 0, 0, 1, 3)
REST = np.array([(0, 0, 1), (0.1, 0, 1), (-0.1, 0, 1.02), (0.1, 0, 0.6), (0.1, 0, 0.2)])


def volume(shape: Shape) -> float:
    """Of a closed surface; negative where its faces look inwards."""
    assert shape.faces is not None
    a, b, c = (shape.points[shape.faces[:, k]].astype(float) for k in range(3))
    return float((np.cross(a, b) * c).sum() / 6.0)


# ---------------------------------------------------------------- solids and lines


def test_balls_are_round_and_look_outwards() -> None:
    made = solids.balls([X, 5 * Y], [0.5, 1.0], [RED, RED])
    first, second = np.split(made.points, 2)
    np.testing.assert_allclose(np.linalg.norm(first - X, axis=1), 0.5, rtol=1e-5)
    np.testing.assert_allclose(np.linalg.norm(second - 5 * Y, axis=1), 1.0, rtol=1e-5)
    assert 0.9 < volume(made) / (4 / 3 * pi * (0.5**3 + 1.0)) < 1.0


def test_arrows_reach_from_foot_to_tip_and_look_outwards() -> None:
    made = solids.arrows([X, X], [2 * TURN[0], 0.05 * Z], 0.03, RED)
    long, short = np.split(made.points.astype(float), 2)
    for points, vector in ((long, 2 * TURN[0]), (short, 0.05 * Z)):
        along = (points - X) @ vector / (vector @ vector)
        assert np.isclose(along.min(), 0.0, atol=1e-5)
        assert np.isclose(along.max(), 1.0, atol=1e-5)
    assert volume(made) > 0.0


def test_nothing_has_no_arrow() -> None:
    assert len(solids.arrows(np.zeros((2, 3)), np.zeros((2, 3)), 0.03, RED).points) == 0


def test_capsules_stay_a_radius_from_their_segments() -> None:
    starts, ends = np.array([X, Z]), np.array([X + 2 * TURN[1], Z])  # the second is a ball
    radii = np.array([0.2, 0.5])
    made = wires.capsules(starts, ends, radii, RED, Look.THIN)
    points = made.points.reshape(-1, 3).astype(float)
    off = []
    for start, end in zip(starts, ends, strict=True):
        way = end - start
        along = (points - start) @ way / max(way @ way, 1e-12)
        off.append(np.linalg.norm(points - start - along.clip(0, 1)[:, None] * way, axis=1))
    apart = np.minimum(*(abs(each - radius) for each, radius in zip(off, radii, strict=True)))
    assert apart.max() < 1e-5
    assert (points @ TURN[1]).max() > (ends[0] @ TURN[1]) + 0.19  # the caps


def test_bodies_span_their_bones_and_look_outwards() -> None:
    heads, tails = np.array([X, Y, Z]), np.array([2 * X, Y + 0.3 * Z, Z])  # the last has no length
    made = solids.bodies(heads, tails, RED)
    assert volume(made) > 0.0
    for place in (*heads[:2], *tails[:2]):
        assert np.linalg.norm(made.points - place, axis=1).min() < 1e-6
    assert np.linalg.norm(made.points - Z, axis=1).min() > 0.1


def test_bodies_have_the_colours_of_their_own_bones() -> None:
    heads, tails = np.array([Z, X, Y]), np.array([Z, 2 * X, Y + 0.3 * Z])  # the first has no length
    faint = np.array([RED, (*RED[:3], 0.5), (*RED[:3], 0.25)])
    made = solids.bodies(heads, tails, faint)
    for head, opacity in ((X, 0.5), (Y, 0.25)):
        at = np.linalg.norm(made.points - head, axis=1).argmin()
        assert made.colours[at, 3] == pytest.approx(opacity)


def test_rings_are_circles_about_their_centres() -> None:
    made = shapes.rings([X, Y], [0.1, 0.2], [RED, RED])
    first, second = np.split(made.points, 2)
    np.testing.assert_allclose(np.linalg.norm(first - X, axis=1), 0.1, rtol=1e-5)
    np.testing.assert_allclose(np.linalg.norm(second - Y, axis=1), 0.2, rtol=1e-5)


def test_dashes_lie_on_the_line_and_leave_gaps() -> None:
    bend = np.array([(0.0, 0, 0), (1.0, 0, 0), (1.0, 1.0, 0)])
    made = shapes.dashed(bend, RED, dash=0.3, gap=0.1, look=Look.THIN)
    pairs = made.points.reshape(-1, 2, 3)
    assert np.isclose(np.linalg.norm(pairs[:, 1] - pairs[:, 0], axis=1).sum(), 1.5, atol=1e-5)
    assert (np.isclose(made.points[:, 0], 1.0) | np.isclose(made.points[:, 1], 0.0)).all()


def test_a_line_without_length_has_no_dashes() -> None:
    still = np.zeros((5, 3))
    assert len(shapes.dashed(still, RED, dash=0.3, gap=0.1, look=Look.THIN).points) == 0


def test_merged_shapes_keep_their_faces_and_lie_row_by_row() -> None:
    """Broadcast colours would reach the graphics card in the wrong order."""
    one, two = solids.balls(X, 1.0, RED), solids.balls(Y, 1.0, (0.0, 1.0, 0.0, 1.0))
    line = shapes.lines([[X, Y]] * 3, RED)
    ball, thin = shapes.merged([one, two, line, solids.none()])
    assert (ball.look, thin.look) == (Look.SOLID, Look.THIN)
    assert np.isclose(volume(ball), volume(one) + volume(two), rtol=1e-5)
    for shape in (ball, thin):
        assert shape.points.flags.c_contiguous
        assert shape.colours.flags.c_contiguous


# ---------------------------------------------------------------- cones and arcs


def test_a_stretched_cones_rim_is_where_the_solver_bounds_it() -> None:
    """Every point of the rim is on the edge, at the angle off the axis that is told."""
    rim = cone_rim(0.6, (2.0, 0.5), 1.0, 32)[:-1]
    count = len(rim)
    along = np.tile(X, (count, 1))
    owns = shortest(along, rim)
    still = np.tile(np.eye(3), (count, 1, 1))
    joints = Joints(np.zeros((count, 3)), still, owns, along)
    seen = cones(joints, along, np.tile(Y, (count, 1)), np.tile((2.0, 0.5), (count, 1)))
    np.testing.assert_allclose(seen.now, edge(seen.narrow, 0.6), atol=1e-6)
    np.testing.assert_allclose(np.cos(seen.now), rim @ X / np.linalg.norm(rim, axis=1), atol=1e-6)


def test_an_arc_ends_at_its_limits() -> None:
    made = list(arcs.arc(-0.4, 1.1, 0.5, RED))
    rim = made[1].points
    np.testing.assert_allclose(np.linalg.norm(rim, axis=1), 0.5, rtol=1e-5)
    angles = np.arctan2(rim[:, 1], rim[:, 0])
    assert (angles.min(), angles.max()) == pytest.approx((-0.4, 1.1), abs=1e-5)
    assert len(made[2].points) == 4  # two spokes


def test_an_open_arc_fades_away() -> None:
    made = list(arcs.arc(0.5, None, 0.5, RED))
    strength = made[1].colours[:, 3]
    assert strength[0] > 0.8
    assert strength[-1] < 0.2
    assert len(made[2].points) == 2  # one spoke


# ---------------------------------------------------------------- joints


def joint(own: np.ndarray, along: np.ndarray = Z) -> Joints:
    """A joint whose parent is turned as well."""
    return Joints(np.zeros((1, 3)), TURN[None], (TURN @ own)[None], along[None])


@pytest.mark.parametrize("bend", [-0.5, 0.05, 1.3])
def test_a_bend_counts_towards_the_known_flexion(bend: float) -> None:
    seen = bends(joint(axis_rotation(1, bend)), Z[None], X[None])
    assert seen.now == pytest.approx(bend, abs=1e-9)
    np.testing.assert_allclose(seen.hands[0], TURN @ axis_rotation(1, bend) @ Z, atol=1e-9)


def test_a_bend_of_unknown_flexion_counts_the_way_it_is_bent() -> None:
    seen = bends(joint(axis_rotation(1, -0.5)), Z[None], np.full((1, 3), np.nan))
    assert seen.now == pytest.approx(0.5)


@pytest.mark.parametrize("twist", [-2.5, 0.0, 0.8])
def test_a_twist_is_free_of_the_swing(twist: float) -> None:
    swing = shortest(Z, (X + 2 * Z) / np.sqrt(5.0))
    seen = twists(joint(swing @ axis_rotation(2, twist)), np.array([0.2]))
    assert seen.now == pytest.approx(twist)
    np.testing.assert_allclose(seen.origins[0], 0.2 * seen.axes[0, :, 2], atol=1e-9)
    np.testing.assert_allclose(seen.axes[0].T @ seen.axes[0], np.eye(3), atol=1e-9)


def test_the_shortest_rotation_brings_one_direction_to_the_other() -> None:
    turns = shortest(np.array([X, X]), np.array([TURN[0], Y]))
    np.testing.assert_allclose(turns @ X, [TURN[0], Y], atol=1e-9)
    np.testing.assert_allclose(turns @ np.swapaxes(turns, 1, 2), [np.eye(3)] * 2, atol=1e-9)


# ---------------------------------------------------------------- figures


def moved() -> tuple[np.ndarray, np.ndarray]:
    """Heads (T, B, 3) of a figure whose root turns and whose leg bends, and turns (T, B, 3, 3)."""
    turns = np.empty((3, 5, 3, 3))
    for t, bend in enumerate((0.2, 0.5, 0.9)):
        root = axis_rotation(2, 0.5 * t) @ TURN
        thigh = root @ axis_rotation(0, bend)
        turns[t] = [root, thigh, root, thigh @ axis_rotation(0, -2 * bend), root]
    heads = np.empty((3, 5, 3))
    for body, parent in enumerate(PARENTS):
        arm = REST[body] - REST[parent] if parent >= 0 else REST[0]
        above = turns[:, parent] if parent >= 0 else np.eye(3)
        heads[:, body] = (heads[:, parent] if parent >= 0 else 0.0) + above @ arm
    return heads, turns


def figure() -> TracedFigure:
    heads, _ = moved()
    tails = heads.copy()
    tails[:, 1], tails[:, 3], tails[:, 0] = heads[:, 3], heads[:, 4], heads[:, 1]
    tails[:, 2] += 0.1
    tails[:, 4] += 0.1
    turns = body_turns(PARENTS, REST, heads)
    names = ("hips", "thigh", "other", "shin", "foot")
    return TracedFigure(np.array([1.0, 2.0, 3.0]), names, PARENTS, REST, heads, tails, turns)


def test_turns_of_bodies_are_found_from_their_joints() -> None:
    """A root between two hips is turned as these; a leg that does not twist, as it swings."""
    heads, turns = moved()
    spread = np.concatenate([REST, [(0.0, 0.0, 1.3)]])  # a spine, so that the hips are no line
    spine = heads[:, 0] + turns[:, 0] @ (spread[5] - REST[0])
    found = body_turns((*PARENTS, 0), spread, np.concatenate([heads, spine[:, None]], axis=1))
    np.testing.assert_allclose(found[:, [0, 1, 3]], turns[:, [0, 1, 3]], atol=1e-6)


def test_leans_and_flexion_are_those_of_the_recording() -> None:
    made = figure()
    ahead = made.heads[1, 4] - made.heads[1, 3]
    lean = made.turns[1, 1].T @ ahead / np.linalg.norm(ahead)
    np.testing.assert_allclose(made.lean(3, 2.0, 2.0), lean, atol=1e-9)
    straight = made.along[1]
    assert made.flexion[3] @ straight == pytest.approx(0.0, abs=1e-9)
    assert made.flexion[3] @ lean > 0.3


def test_a_pose_of_another_instant_hangs_on_the_figures_own_body() -> None:
    made = figure()
    heads, tails = posed(made, 2, made, 0, (3, 4))
    np.testing.assert_allclose(heads[0], made.heads[0, 3], atol=1e-9)  # the knee stays
    turned = made.turns[0, 1] @ made.turns[2, 1].T
    shin = made.heads[2, 4] - made.heads[2, 3]
    np.testing.assert_allclose(heads[1] - heads[0], turned @ shin, atol=1e-9)
    np.testing.assert_allclose(tails[0], heads[1], atol=1e-9)
