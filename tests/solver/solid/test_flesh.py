"""Shapes from a skinned mesh: tubes of known girth are found, whatever else hangs on the bones."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hangtime.solver.arrays import FloatArray
from hangtime.solver.body.anatomy import Part
from hangtime.solver.body.character import Body, Character, build_character
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.data.recording import Bone, Recording, Skin
from hangtime.solver.data.requests import Requests, Shape
from hangtime.solver.data.scaling import scaled_problem, scaled_recording
from hangtime.solver.data.solver_options import ShapeSource, SolverOptions
from hangtime.solver.solid.flesh import MOST, Flesh, flesh_of
from hangtime.solver.solid.shape_changes import ShapeChanges
from hangtime.solver.solid.shapes import SOLID_SHARE, capsules
from hangtime.solver.stages.setup import set_up
from hangtime.tests.helpers.clips import JUMP, load_recording
from hangtime.tests.helpers.fitted_hop import fitted_hop

POINTS = 1500
NEAR = 0.02  # of its radius, within which a girth is found


@cache
def figure() -> tuple[Recording, Character]:
    recording = load_recording(JUMP)
    return recording, build_character(recording)


def body(bone: str) -> tuple[int, Body]:
    bodies = figure()[1].bodies
    index = next(i for i, each in enumerate(bodies) if each.bone == bone)
    return index, bodies[index]


def tube(
    bone: str,
    radius: float | tuple[float, float],
    *,
    centre: tuple[float, float] = (0.0, 0.0),
    reach: tuple[float, float] = (-0.1, 1.1),
    count: int = POINTS,
) -> FloatArray:
    """Points (count, 3) m on an elliptic tube about a body, in its rest pose.

    radius, centre: m, along its box's width and depth. reach: where it begins and ends, as shares
    of the way to the tip.
    """
    recording, _ = figure()
    mine = body(bone)[1]
    chance = np.random.default_rng(1)
    angle, along = chance.uniform(0.0, 2.0 * np.pi, count), chance.uniform(*reach, count)
    round_it = np.stack([np.cos(angle), np.sin(angle)], axis=1) * radius + np.array(centre)
    local = round_it @ mine.box_rotation[:, :2].T + along[:, None] * mine.tip
    return np.asarray(recording.bones[recording.index(bone)].head + local)


def found(*parts: tuple[str, FloatArray]) -> dict[int, Flesh]:
    """The flesh of points by bones' names."""
    return flesh_of(skin(*parts), *figure())


def skin(*parts: tuple[str, FloatArray]) -> Skin:
    owners = np.concatenate([np.full(len(points), i) for i, (_, points) in enumerate(parts)])
    bones = tuple(bone for bone, _ in parts)
    return Skin(("Body",), bones, np.concatenate([points for _, points in parts]), owners)


@pytest.mark.parametrize("bone", ["LeftArm", "LeftForeArm", "RightUpLeg", "RightLeg", "Neck"])
@pytest.mark.parametrize("radius", [0.02, 0.05])
def test_a_tube_is_found_as_thick_as_it_is(bone: str, radius: float) -> None:
    index, _ = body(bone)
    flesh = found((bone, tube(bone, radius)))
    assert set(flesh) == {index}
    assert flesh[index].radius == pytest.approx(radius, rel=NEAR)
    assert np.linalg.norm(flesh[index].centre) < NEAR * radius
    shape = next(
        each for each in capsules(figure()[1], ShapeChanges(flesh=flesh)) if each.body == index
    )
    assert shape.radius == pytest.approx(SOLID_SHARE * radius, rel=NEAR)


def test_what_lies_beside_its_bone_is_found_there() -> None:
    index, shank = body("LeftLeg")
    flesh = found(("LeftLeg", tube("LeftLeg", 0.05, centre=(0.01, -0.02))))[index]
    aside = flesh.centre @ shank.box_rotation
    np.testing.assert_allclose(aside, (0.01, -0.02, 0.0), atol=0.001)
    assert flesh.radius == pytest.approx(0.05, rel=NEAR)


def test_a_trunk_is_two_side_by_side_where_it_is_wide() -> None:
    index, spine = body("Spine")
    assert spine.part is Part.SPINE
    flesh = found(("Spine", tube("Spine", (0.16, 0.11), reach=(-1.0, 2.0))))
    shapes = capsules(figure()[1], ShapeChanges(flesh=flesh))
    mine = [each for each in shapes if each.body == index]
    assert len(mine) == 2
    width = np.linalg.norm(mine[0].start - mine[1].start) + 2.0 * mine[0].radius
    assert width == pytest.approx(2.0 * SOLID_SHARE * 0.16, rel=0.05)
    assert mine[0].radius == pytest.approx(SOLID_SHARE * 0.11, rel=0.05)
    across = (mine[0].start - mine[1].start) @ spine.box_rotation
    assert abs(across[0]) > 10.0 * abs(across[1])


def test_a_head_ends_where_its_mesh_does() -> None:
    index, head = body("Head")
    flesh = found(("Head", tube("Head", 0.05, reach=(0.0, 0.7))))[index]
    assert flesh.reach == pytest.approx(0.7, abs=0.03)
    shape = next(
        each
        for each in capsules(figure()[1], ShapeChanges(flesh={index: flesh}))
        if each.body == index
    )
    top = np.linalg.norm(shape.end) + shape.radius
    assert top == pytest.approx(flesh.reach * np.linalg.norm(head.tip), rel=0.05)


def test_hair_cloth_and_what_a_hand_holds_do_not_make_it_thicker() -> None:
    """As long as they are less than half of what there is in each direction."""
    index, _ = body("LeftForeArm")
    arm, sleeve = tube("LeftForeArm", 0.04), tube("LeftForeArm", 0.15, count=POINTS // 3)
    flesh = found(("LeftForeArm", np.concatenate([arm, sleeve])))[index]
    assert flesh.radius == pytest.approx(0.04, rel=0.05)


def test_nothing_is_more_than_twice_as_thick_as_its_mass_makes_it() -> None:
    index, arm = body("LeftForeArm")
    flesh = found(("LeftForeArm", tube("LeftForeArm", 0.3)))[index]
    wide, deep, _ = arm.box_size
    assert flesh.radius == pytest.approx(MOST * np.sqrt(wide * deep / np.pi), rel=1e-6)


@pytest.mark.parametrize("bone", ["LeftHandIndex1", "LeftFingerBase", "LThumb"])
def test_fingers_go_with_their_hand(bone: str) -> None:
    index, _ = body("LeftHand")
    assert set(found((bone, tube("LeftHand", 0.03, reach=(0.0, 1.0))))) == {index}


def test_a_bone_of_another_family_goes_with_the_body_in_which_it_lies() -> None:
    """As `arm_stretch.l`, which hangs on the root's control."""
    recording, character = figure()
    index, arm = body("LeftArm")
    head = recording.bones[recording.index("LeftArm")].head
    loose = Bone("arm_stretch.l", -1, head, head + 0.5 * arm.tip, np.eye(3))
    far = replace(loose, name="cloth", head=head + 1.0, tail=head + 1.1)
    more = replace(
        recording,
        bones=(*recording.bones, loose, far),
        heads=np.concatenate([recording.heads, recording.heads[:, :2]], axis=1),
        rotations=np.concatenate([recording.rotations, recording.rotations[:, :2]], axis=1),
    )
    tubes = (("arm_stretch.l", tube("LeftArm", 0.04)), ("cloth", tube("LeftLeg", 0.05)))
    flesh = flesh_of(skin(*tubes), more, character)
    assert list(flesh) == [index]
    assert flesh[index].radius == pytest.approx(0.04, rel=NEAR)


def test_too_little_mesh_or_a_load_beside_the_bone_tells_nothing() -> None:
    assert found(("LeftLeg", tube("LeftLeg", 0.05, count=20))) == {}
    assert found(("LeftLeg", tube("LeftLeg", 0.05, centre=(0.2, 0.0)))) == {}
    assert found(("Tail", tube("LeftLeg", 0.05))) == {}
    shell = tube("LeftLeg", 0.05)
    outwards = (shell - shell.mean(axis=0)) @ body("LeftLeg")[1].box_rotation[:, 0]
    assert found(("LeftLeg", shell[outwards > 0.04])) == {}


def test_thickness_by_hand_multiplies_the_meshs() -> None:
    character = figure()[1]
    flesh = found(("LeftLeg", tube("LeftLeg", 0.05)))
    thick = Shape("Boot", ("LeftLeg",), thickness=1.5)
    shapes = [
        next(each for each in capsules(character, changes) if each.body == body("LeftLeg")[0])
        for changes in (
            ShapeChanges(flesh=flesh),
            ShapeChanges.of((thick,), character, flesh),
        )
    ]
    assert shapes[1].radius == pytest.approx(1.5 * shapes[0].radius)


def test_a_stated_stature_scales_the_mesh_as_it_does_the_bones() -> None:
    recording, _ = figure()
    problem = MotionProblem(skin=skin(("LeftLeg", tube("LeftLeg", 0.05))))
    taller = scaled_recording(recording, 1.2)
    flesh = flesh_of(scaled_problem(problem, 1.2).skin, taller, build_character(taller))
    assert flesh[body("LeftLeg")[0]].radius == pytest.approx(1.2 * 0.05, rel=NEAR)


@pytest.mark.parametrize("source", ShapeSource)
def test_an_adaptation_keeps_the_meshs_shapes_apart_unless_told_otherwise(
    source: ShapeSource,
) -> None:
    fit = fitted_hop()
    recording, character = fit.performance.recording, fit.performance.character
    leg = next(each for each in character.bodies if each.bone == "LeftLeg")
    head = recording.bones[recording.index("LeftLeg")].head
    points = tube("LeftLeg", 0.03) - figure()[0].bones[figure()[0].index("LeftLeg")].head
    problem = MotionProblem(
        skin=skin(("LeftLeg", points + head)),
        requests=Requests(solution=SolverOptions(shapes=source)),
    )
    changes = set_up(fit, problem).changes
    (shape,) = (each for each in capsules(character, changes) if character.bodies[each.body] is leg)
    (plain,) = (each for each in capsules(character) if character.bodies[each.body] is leg)
    if source is ShapeSource.MESH:
        assert shape.radius == pytest.approx(SOLID_SHARE * 0.03, rel=NEAR)
    else:
        assert shape.radius == plain.radius
