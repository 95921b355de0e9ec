"""Hops in a scene: onto a crate and a slope, and onto what friction does not hold."""

from contextlib import nullcontext
from dataclasses import replace

import numpy as np
import pytest
from hangtime.operators.words.messages import sentence
from hangtime.solver.analysis.pins.landing import Footing
from hangtime.solver.arrays import FloatArray
from hangtime.solver.data.faults import (
    Fault,
    InsideOut,
    NoFaces,
    NoRoom,
    NotFinite,
    NotGround,
    NoThickness,
    SameObjectName,
    StandsBelow,
    StandsIn,
    TooSteep,
    UnknownObject,
)
from hangtime.solver.data.problem import MotionProblem, Pin
from hangtime.solver.data.requests import PointRequest, Requests, When
from hangtime.solver.data.row_kinds import RowKind
from hangtime.solver.data.scaling import scaled_problem
from hangtime.solver.data.scene import SceneObject, SceneRole
from hangtime.solver.data.status import Durations
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.solver.results.violations import condition_violations
from hangtime.solver.scene.checks import check_scene
from hangtime.solver.solid.solid_world import MOST_ROWS
from hangtime.solver.stages.footing import check_sunk, find_footing
from hangtime.solver.stages.implicit import Adaptation, adapt
from hangtime.solver.stages.setup import set_up
from hangtime.tests.helpers.fitted_hop import HOP, HOP_CLIP, fitted_hop, frames_of
from hangtime.tests.helpers.meshes import box, thing

DEEPEST = 2.0  # mm, beyond what the soles have in the recording's floor
PIN = Pin("Landing", "ground 2", offset=(0.1, 0.0, 0.2), on="Crate")


def crate(degrees: float, axis: int = 0) -> SceneObject:
    """A slab whose upper face is below the landing, tilted about a horizontal axis."""
    bare = Pin("Landing", "ground 2", offset=PIN.offset)
    fit = fitted_hop()
    found = find_footing(fit, MotionProblem(pins=(bare,)), fit.schedule).places
    landing = found[[c.start > 0.6 for c in fit.schedule.contacts]].mean(axis=0)
    tilt = axis_rotation(axis, np.radians(degrees))
    place = landing - tilt @ np.array([0.0, 0.0, 0.05])
    return thing("Crate", box((0.8, 0.5, 0.1)), tuple(place.tolist()), rotation=tilt)


def solved(degrees: float) -> tuple[Adaptation, FloatArray]:
    """The hop onto the slab, and its normal."""
    slab = crate(degrees)
    return adapt(fitted_hop(), MotionProblem(pins=(PIN,), scene=(slab,))), slab.rotations[0][:, 2]


@pytest.mark.parametrize("degrees", [0.0, pytest.param(-30.0, marks=pytest.mark.slow)])
def test_a_hop_lands_on_faces(degrees: float) -> None:
    found, normal = solved(degrees)
    assert found.solved
    inside = [row for row in condition_violations(found) if "Crate" in row.name]
    assert all(row.kind is RowKind.SOLID for row in inside)
    assert max((row.amount for row in inside), default=0.0) < DEEPEST
    contacts = found.motion.transcription.contacts
    landed = {c.contact.point for c in contacts if np.allclose(c.normal, normal)}
    assert landed >= {"Left heel", "Left toe", "Right heel", "Right toe"}


def test_a_slope_that_friction_does_not_hold_is_refused() -> None:
    with pytest.raises(TooSteep) as caught:
        adapt(fitted_hop(), MotionProblem(pins=(PIN,), scene=(crate(-50.0),)))
    assert caught.value.slope == pytest.approx(50.0, abs=0.1)


def obstacle(*, flip: bool = False) -> SceneObject:
    vertices, triangles = box((0.1, 0.1, 2.0))
    mesh = vertices, triangles[:, ::-1] if flip else triangles
    return thing("Post", mesh, role=SceneRole.OBSTACLE)


BROKEN = np.full((3, 3), np.nan), np.array([[0, 1, 2]])


@pytest.mark.parametrize(
    ("fault", "scene", "on"),
    [
        (NoFaces, (thing("A", (np.zeros((3, 3)), np.zeros((0, 3), int))),), None),
        (NoFaces, (thing("A", (np.zeros((3, 3)), np.array([[0, 1, 2]]))),), None),
        (NoThickness, (thing("A", box((1.0, 1.0, 0.0))),), None),
        (NotFinite, (thing("A", BROKEN),), None),
        (InsideOut, (obstacle(flip=True),), None),
        (SameObjectName, (obstacle(), obstacle()), None),
        (UnknownObject, (obstacle(),), "Crate"),
        (NotGround, (obstacle(),), "Post"),
    ],
)
def test_faulty_scenes_are_refused(
    fault: type[Fault], scene: tuple[SceneObject, ...], on: str | None
) -> None:
    pins = () if on is None else (Pin("Landing", "ground 2", on=on),)
    with pytest.raises(fault):
        check_scene(MotionProblem(pins=pins, scene=scene))


def test_a_stated_stature_scales_the_scene() -> None:
    scaled = scaled_problem(MotionProblem(scene=(obstacle(),)), 2.0).scene[0]
    np.testing.assert_allclose(scaled.vertices, 2.0 * obstacle().vertices)


def stood(height: float, size: tuple[float, float, float], *, at: str = "ground 2") -> SceneObject:
    """A slab with its top at a height above the floor, about the contacts of a phase."""
    schedule = fitted_hop().schedule
    (phase,) = (each for each in schedule.phases if each.name == at)
    middle = np.mean([c.place for c in schedule.of_phase(phase)], axis=0)
    top = schedule.floor_m + height - 0.5 * size[2]
    return thing("Slab", box(size), (float(middle[0]), float(middle[1]), top))


def test_a_recording_below_the_floor_that_it_is_given_is_told() -> None:
    with pytest.raises(StandsBelow) as caught:
        adapt(fitted_hop(), MotionProblem(scene=(stood(0.1, (9.0, 9.0, 1.0)),)))
    assert caught.value.metres == pytest.approx(0.1, abs=0.01)


def test_a_stance_in_a_crate_is_told_by_its_contact() -> None:
    crate = stood(0.3, (0.9, 0.9, 0.3))
    with pytest.raises(StandsIn) as caught:
        adapt(fitted_hop(), MotionProblem(scene=(crate,)))
    landing = [c.name for c in fitted_hop().schedule.contacts if c.start > 0.6]
    assert caught.value.contact in landing
    assert caught.value.metres == pytest.approx(0.3, abs=0.01)


def wall(deep: float, role: SceneRole = SceneRole.GROUND) -> SceneObject:
    """A wall with the foremost place of the landing that far behind its face, m."""
    places = np.array([c.place for c in fitted_hop().schedule.contacts if c.start > 0.6])
    x, y, _ = places[places[:, 1].argmin()].tolist()
    return thing("Wall", box((3.0, 0.2, 3.0)), (x, y + deep - 0.1, 1.4), role=role)


def test_who_is_at_the_face_of_a_wall_is_not_below_its_top() -> None:
    check_sunk((wall(0.03),), fitted_hop().schedule, recorded_footing())
    with pytest.raises(StandsIn) as caught:
        check_sunk((wall(0.06),), fitted_hop().schedule, recorded_footing())
    assert (caught.value.metres, caught.value.beside) == (pytest.approx(0.06), True)
    assert "6.0 cm behind the face at its side" in sentence(caught.value)


def test_a_crate_s_underside_is_no_way_out_of_it() -> None:
    """A crate that is 1 cm in the floor was let through: its nearest face is below the foot."""
    crate = stood(0.49, (1.2, 1.2, 0.5))
    with pytest.raises(StandsIn) as caught:
        check_sunk((crate,), fitted_hop().schedule, recorded_footing())
    assert (caught.value.metres, caught.value.beside) == (pytest.approx(0.49, abs=0.01), False)


@pytest.mark.parametrize("bottom", [0.0, -0.01])
def test_who_is_at_the_face_of_a_wall_that_ends_at_the_floor_may_stand_there(
    bottom: float,
) -> None:
    high = wall(0.03)
    lifted = high.positions + np.array([0.0, 0.0, 0.1 + bottom])  # whose bottom is at -0.1 m
    check_sunk((replace(high, positions=lifted),), fitted_hop().schedule, recorded_footing())


def test_a_point_that_pushes_back_at_a_wall_is_pushed_off_it() -> None:
    start, _ = frames_of(HOP_CLIP, HOP)
    hand = PointRequest(
        "Hand",
        "RightHand",
        When(frames=(start, start + 30)),
        place=(0.0, 0.05, 1.4),
        environment=True,
    )
    wall = thing("Wall", box((3.0, 0.2, 3.0)), (0.0, -0.1, 1.4), role=SceneRole.OBSTACLE)
    for scene, normal in (((wall,), (0.0, 1.0, 0.0)), ((), (0.0, 0.0, 1.0))):
        problem = MotionProblem(requests=Requests(points=(hand,)), scene=scene)
        contacts = set_up(fitted_hop(), problem).start.transcription.contacts
        (held,) = (c for c in contacts if c.contact.name == "Hand")
        assert tuple(held.normal) == pytest.approx(normal)


@pytest.mark.parametrize("height", [0.0, 0.02])
def test_a_floor_a_little_off_is_none_to_stand_in(height: float) -> None:
    check_sunk((stood(height, (9.0, 9.0, 1.0)),), fitted_hop().schedule, recorded_footing())


@pytest.mark.parametrize(("height", "sunk"), [(0.31, True), (0.35, False)])
def test_who_is_below_a_sheet_is_in_it_as_far_down_as_it_goes(height: float, *, sunk: bool) -> None:
    """Looked at is the place a little above, so that what is near is near that."""
    corners = np.array([[-9.0, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]])
    floor = fitted_hop().schedule.floor_m
    sheet = thing("Sheet", (corners, np.array([[0, 1, 2], [0, 2, 3]])), (0.0, 0.0, floor + height))
    with pytest.raises(StandsBelow) if sunk else nullcontext():
        check_sunk((sheet,), fitted_hop().schedule, recorded_footing())


def recorded_footing() -> Footing:
    return find_footing(fitted_hop(), MotionProblem(), fitted_hop().schedule)


def ceiling(above: float) -> SceneObject:
    """A slab over where the hop lands, that far above the floor."""
    fit = fitted_hop()
    landed = [c.start > 0.6 for c in fit.schedule.contacts]
    x, y, z = fit.places[landed].mean(axis=0).tolist()
    slab = box((1.2, 1.2, 0.1))
    return thing("Ceiling", slab, (x, y, z + above + 0.05), role=SceneRole.OBSTACLE)


def test_a_ceiling_under_which_no_leg_fits_is_told_before_the_solve() -> None:
    with pytest.raises(NoRoom) as caught:
        set_up(fitted_hop(), MotionProblem(scene=(ceiling(0.3),)))
    assert caught.value.thing == "Ceiling"
    assert caught.value.free == pytest.approx(0.3, abs=0.01)
    assert caught.value.needed > 0.35
    set_up(fitted_hop(), MotionProblem(scene=(ceiling(0.6),)))  # whoever crouches would do


@pytest.mark.slow
def test_a_body_that_is_all_in_something_gets_no_more_rows_than_a_step_can_bear() -> None:
    setup = set_up(fitted_hop(), MotionProblem(scene=(ceiling(0.9),)))
    assert setup.solid is not None
    rows = setup.solid.rows(setup.start, frozenset())
    assert rows is not None
    assert len(rows.items) <= MOST_ROWS
    found = {rows.names[item] for item in rows.items.tolist()}
    assert "Pelvis in Ceiling" in found


@pytest.mark.slow
def test_a_jump_that_its_own_durations_take_through_a_ceiling_keeps_the_recorded_ones() -> None:
    found = adapt(
        fitted_hop(),
        MotionProblem(
            pins=(Pin("Landing", "ground 2", offset=(0.4, 0.0, 0.0)),), scene=(ceiling(1.06),)
        ),
    )
    assert found.solved
    assert found.setup.durations is Durations.NOT_MET
    beyond = [each for guard in found.setup.guards for each in guard.violations(found.motion)]
    assert all(each.amount < 3.0 * each.kind.tolerance for each in beyond), beyond


@pytest.mark.slow
def test_a_ceiling_under_which_nobody_fits_is_told_after_an_attempt_or_two() -> None:
    heard: list[str] = []
    found = adapt(
        fitted_hop(),
        MotionProblem(
            pins=(Pin("Landing", "ground 2", offset=(0.1, 0.0, 0.0)),), scene=(ceiling(0.9),)
        ),
        progress=lambda step, _: heard.append(step.stage),
    )
    assert any(row.name == "Pelvis in Ceiling" for row in condition_violations(found))
    assert heard.count("adapt") < 24
