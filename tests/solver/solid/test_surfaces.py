"""Distances between solids: against MuJoCo's, their Jacobians, and which solids may meet."""

from dataclasses import replace
from functools import cache

import mujoco
import numpy as np
import pytest
from hangtime.solver.arrays import IntArray
from hangtime.solver.body.anatomy import Part
from hangtime.solver.data.faults import BeyondReason, NotAboveZero, StillBone
from hangtime.solver.data.requests import Shape, Through
from hangtime.solver.solid.mesh_surface import scene_shapes
from hangtime.solver.solid.penetrations import Penetrations, placed_at
from hangtime.solver.solid.segments import closest_shares
from hangtime.solver.solid.shape_changes import ShapeChanges
from hangtime.solver.solid.shapes import Capsules, capsules, floor_balls, meeting_pairs
from hangtime.solver.solid.solid_world import SolidDistance
from hangtime.solver.solid.surfaces import Floor, OwnLimbs, Placed, Surfaces
from hangtime.solver.transcription.motion import Motion
from hangtime.solver.transcription.sampling import Instants, State
from hangtime.tests.helpers.fitted_hop import fitted_hop
from hangtime.tests.helpers.toy_problems import jacobian_error

TIMES = np.array([0.013, 0.21, 0.48, 0.7, 1.2])


@cache
def surfaces() -> Surfaces:
    """The hop's figure above a floor so high that its legs are in it."""
    motion = fitted_hop().motion
    character = motion.transcription.character
    shapes = capsules(character)
    pairs = meeting_pairs(character, shapes)
    balls = Capsules.of(floor_balls(character, motion.transcription.points))
    own = OwnLimbs(Capsules.of(shapes), pairs, tuple(f"{i} in {j}" for i, j in pairs))
    names = tuple(f"{body} in the floor" for body in balls.bodies)
    return Surfaces((own, Floor(balls, lambda times: np.full(len(times), 0.3), names)))


def folded() -> Motion:
    """The hop with all joints bent half as far again, so that limbs are in each other."""
    motion = fitted_hop().motion
    t = motion.transcription
    x = motion.x.copy()
    x[:, t.layout.joint_angles] *= 1.5
    return Motion(t, x, motion.places)


def every(placed: Placed) -> tuple[IntArray, IntArray]:
    """Every item at every instant."""
    instants, items = np.indices((len(placed.times), len(surfaces().names)))
    return instants.ravel(), items.ravel()


def mujocos(placed: Placed, at: int) -> np.ndarray:
    """Distances of all items at an instant, by MuJoCo's capsules, balls and plane."""
    own, floor = surfaces().parts
    assert isinstance(own, OwnLimbs)
    assert isinstance(floor, Floor)
    geoms = ['<geom type="plane" size="9 9 1" pos="0 0 0.3"/>']
    for kind, where, shapes in (("capsule", "fromto", own.shapes), ("sphere", "pos", floor.balls)):
        ends = np.concatenate(shapes.ends(placed.pose), axis=2)[at] + np.tile(placed.com[at], 2)
        for line, radius in zip(ends.tolist(), shapes.radius, strict=True):
            said = " ".join(map(repr, line if kind == "capsule" else line[:3]))
            size = max(radius, 1e-9)  # MuJoCo has no points
            geoms.append(f'<geom type="{kind}" {where}="{said}" size="{size}"/>')
    text = f"<mujoco><worldbody>{''.join(geoms)}</worldbody></mujoco>"
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    pairs = [(1 + i, 1 + j) for i, j in own.pairs.tolist()]
    pairs += [(0, 1 + len(own.shapes.radius) + k) for k in range(len(floor.balls.radius))]
    return np.array([mujoco.mj_geomDistance(model, data, *pair, 9.0, None) for pair in pairs])


def test_distances_are_mujocos() -> None:
    placed = placed_at(folded(), TIMES)
    instants, items = every(placed)
    found = surfaces().closest(placed, instants, items)
    theirs = np.concatenate([mujocos(placed, at) for at in range(len(TIMES))])
    assert theirs.min() < -0.02  # else nothing of what counts was tested
    np.testing.assert_allclose(found.distance, theirs, atol=2e-6)


def test_what_is_deep_is_found_and_nothing_else() -> None:
    placed = placed_at(folded(), TIMES)
    instants, items = every(placed)
    deep = surfaces().closest(placed, instants, items).distance < 0.0
    near = set(zip(*(each.tolist() for each in surfaces().near(placed)), strict=True))
    assert near == set(zip(instants[deep].tolist(), items[deep].tolist(), strict=True))
    assert near


@pytest.mark.parametrize("seed", range(3))
def test_the_jacobian_is_the_distances_derivative(seed: int) -> None:
    motion = folded()
    t = motion.transcription
    placed = placed_at(motion, TIMES)
    instants, items = every(placed)
    near = surfaces().closest(placed, instants, items).distance < 0.05  # rows keep them apart, too
    instants, items = instants[near], items[near]
    nothing = np.zeros(len(items))
    where = Penetrations(
        surfaces().names, items, TIMES[instants], nothing, nothing, np.zeros((len(items), 3))
    )
    state = State(t.character, t.layout, Instants(t.basis, where.times), motion.x)
    assert jacobian_error(state, SolidDistance(surfaces(), where), seed) < 1e-5


def test_a_limb_that_passed_anothers_axis_goes_back_the_way_it_came() -> None:
    """Depth grows on, and the way out keeps its direction; half-way out again it is the shorter."""
    bar = (
        np.array([[-0.5, 0.0, 0.0], [0.0, -0.5, 0.0]]),
        np.array([[0.5, 0.0, 0.0], [0.0, 0.5, 0.0]]),
    )
    own = OwnLimbs(Capsules(np.arange(2), *bar, np.full(2, 0.05)), np.array([[0, 1]]), ("x",))
    placed = placed_at(fitted_hop().motion, np.zeros(1))
    heights = (0.03, 0.01, -0.01, -0.03, -0.07)
    distances, normals = [], []
    for height in heights:
        pose = placed.pose
        pose.rotations[:] = np.eye(3)
        pose.centres[:, 0], pose.centres[:, 1] = [0.0, 0.0, height], 0.0
        none = np.zeros(1, dtype=int)
        found = own.closest(placed, none, none)
        found = found.from_side(np.array([[0.0, 0.0, 1.0]]), pose, none)
        distances.append(float(found.distance[0]))
        normals.append(float(found.normal[0, 2]))
    assert distances == pytest.approx([-0.07, -0.09, -0.11, -0.13, -0.03])
    assert normals == pytest.approx([1.0, 1.0, 1.0, 1.0, -1.0])


def test_closest_points_are_closer_than_any_others() -> None:
    random = np.random.default_rng(1)
    p, u, q, v = random.normal(size=(4, 200, 3))
    v[:50] = u[:50] * random.normal(size=(50, 1))  # parallel
    u[50:60] = 0.0  # points
    s, t = closest_shares(p, u, q, v)
    ours = np.linalg.norm(p + s[:, None] * u - q - t[:, None] * v, axis=1)
    shares = np.linspace(0.0, 1.0, 41)
    first = p[:, None] + shares[:, None] * u[:, None]
    second = q[:, None] + shares[:, None] * v[:, None]
    sampled = np.linalg.norm(first[:, :, None] - second[:, None], axis=3).min(axis=(1, 2))
    assert (ours <= sampled + 1e-9).all()
    assert (ours > sampled - 0.1).all()


def test_shapes_are_a_persons() -> None:
    """Girths lie between a limb's thinnest and its thickest, to a tenth (of grown men, rounded).

    Girths go with the root of mass over height; of a body 0.8 are solid.
    """
    character = fitted_hop().motion.transcription.character
    girths = {Part.THIGH: (0.38, 0.63), Part.SHANK: (0.22, 0.39), Part.FOREARM: (0.17, 0.31)}
    girths[Part.UPPER_ARM] = (0.25, 0.36)
    for shape in capsules(character):
        low, high = girths.get(character.bodies[shape.body].part, (0.0, np.inf))
        scale = 0.8 * np.sqrt(character.mass / character.height / (85.5 / 1.756))
        assert 0.9 * low * scale < 2.0 * np.pi * shape.radius < 1.1 * high * scale


def test_neighbours_may_touch_and_both_legs_may_not() -> None:
    character = fitted_hop().motion.transcription.character
    shapes = capsules(character)
    names = [character.bodies[shape.body].name for shape in shapes]
    pairs = {frozenset((names[i], names[j])) for i, j in meeting_pairs(character, shapes)}
    for one, other in (
        ("left hand", "left thigh"),
        ("left thigh", "right thigh"),
        ("left forearm", "head"),
        ("left toe", "right shank"),
    ):
        assert frozenset((one, other)) in pairs
    for one, other in (("left thigh", "left shank"), ("left forearm", "left upper arm")):
        assert frozenset((one, other)) not in pairs


def meeting(shape: Shape) -> set[frozenset[str]]:
    """Names of the bodies that meet, with a shape's changes."""
    character = fitted_hop().motion.transcription.character
    changes = ShapeChanges.of((shape,), character)
    shapes = capsules(character, changes)
    names = [character.bodies[each.body].name for each in shapes]
    pairs = meeting_pairs(character, shapes, changes)
    return {frozenset((names[i], names[j])) for i, j in pairs}


def test_what_goes_through_each_other_still_meets_all_else() -> None:
    pairs = meeting(Shape("Bag", ("LeftHand", "LeftLeg"), through=Through.EACH_OTHER))
    assert frozenset(("left hand", "left shank")) not in pairs
    assert frozenset(("left hand", "left thigh")) in pairs
    assert frozenset(("right hand", "left shank")) in pairs


def test_what_goes_through_all_meets_nothing() -> None:
    shape = Shape("Hair", ("LeftHand",), through=Through.ALL)
    assert not any("left hand" in pair for pair in meeting(shape))
    t = fitted_hop().motion.transcription
    changes = ShapeChanges.of((shape,), t.character)
    for find in (floor_balls, scene_shapes):
        bodies = {
            t.character.bodies[each.body].name for each in find(t.character, t.points, changes)
        }
        assert "left hand" not in bodies
        assert "right hand" in bodies


def test_thickness_is_a_factor_on_the_radius() -> None:
    character = fitted_hop().motion.transcription.character
    twice = Shape("Sleeve", ("LeftForeArm",), thickness=2.0)
    changes = ShapeChanges.of((twice, replace(twice, name="Again", thickness=1.5)), character)
    for before, after in zip(capsules(character), capsules(character, changes), strict=True):
        thick = 3.0 if character.bodies[before.body].name == "left forearm" else 1.0
        assert after.radius == pytest.approx(thick * before.radius)


def test_a_shape_of_no_thickness_or_too_much_or_of_no_body_is_refused() -> None:
    character = fitted_hop().motion.transcription.character
    with pytest.raises(NotAboveZero):
        ShapeChanges.of((Shape("Ghost", ("Head",), thickness=0.0),), character)
    for beyond in (1e12, 4.0):  # which four times four is, too
        shape = Shape("Giant", ("Head",), thickness=beyond)
        with pytest.raises(BeyondReason):  # arrays larger than any memory
            ShapeChanges.of((shape, replace(shape, name="Again")), character)
    with pytest.raises(StillBone):
        ShapeChanges.of((Shape("Tail", ("Tail",)),), character)


def test_a_standing_foot_is_not_in_the_floor() -> None:
    fitted = fitted_hop()
    motion = fitted.motion
    balls = Capsules.of(floor_balls(motion.transcription.character, motion.transcription.points))
    floor = Floor(balls, lambda times: np.full(len(times), fitted.schedule.floor_m), ())
    placed = placed_at(motion, np.linspace(0.0, motion.duration, 60))
    items = np.arange(len(balls.radius))
    lowest = min(
        float(floor.closest(placed, np.full(len(items), at), items).distance.min())
        for at in range(len(placed.times))
    )
    assert -0.01 < lowest < 0.01
