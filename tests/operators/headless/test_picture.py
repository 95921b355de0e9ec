"""The figures of a picture, and what is drawn beside them."""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from hangtime.bridge.picture.annotations import Bar, Mark, Sphere, Thing
from hangtime.bridge.picture.layout import lay_out
from hangtime.operators.headless.annotate import recorded_on
from hangtime.operators.headless.picture import (
    ContactHold,
    bars,
    goes_sideways,
    heading,
    limbs,
    on_walls,
    posts,
    recorded_row,
)
from hangtime.solver.analysis.performance import perform
from hangtime.solver.body.anatomy import Part, Side
from hangtime.solver.body.character import build_character
from hangtime.solver.data.constants import UP
from hangtime.solver.data.problem import MotionProblem, Pin
from hangtime.solver.data.requests import Hold, Requests
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.solver.stages.implicit import Adaptation, adapt
from hangtime.solver.transcription.contact_pins import PointContact
from hangtime.tests.helpers.clips import JUMP, load_recording
from hangtime.tests.helpers.fitted_hop import fitted_hop, hop
from hangtime.tests.helpers.meshes import box, thing

NEAR = 0.06  # m, that a slice of the trunk is drawn beyond its box


@pytest.mark.parametrize("name", ["BMC_run.bvh", "131_03_hop.bvh", JUMP])
def test_the_trunk_is_in_one_piece(name: str) -> None:
    """The pelvis's box reaches to where the spine hangs on it, wherever the hips' joint is."""
    recording = load_recording(name)
    character = build_character(recording)
    performance = perform(recording, character)
    drawn = list(limbs(character, performance.rotations, performance.centres))
    pelvis = drawn[0]
    spine = next(i for i, body in enumerate(character.bodies) if body.part is Part.SPINE)
    apart = performance.centres[:, spine] - pelvis.centre
    inside = np.einsum("tji,tj->ti", pelvis.rotation, apart)[:, 2]
    assert (np.abs(inside) < 0.5 * pelvis.size[2] + NEAR).all()


@pytest.mark.slow
@pytest.mark.parametrize("left", [0.0, 0.15])
def test_it_is_seen_from_above_where_contacts_went_sideways_also_without_the_landing(
    left: float,
) -> None:
    """A held frame in flight leaves out all that came after it, contacts among it."""
    fit = fitted_hop()
    frame = float(fit.performance.recording.frames[0]) + 120.0 * 0.6
    held = Requests(holds=(Hold("Hang", frame, 0.1, ends=True),))
    assert not goes_sideways(adapt(fit, MotionProblem(requests=held)), np.eye(3))
    moved = adapt(fit, MotionProblem(pins=(Pin("Landing", "ground 2", offset=(0.0, left, 0.0)),)))
    x, y = fit.performance.com[-1, :2] - fit.performance.com[0, :2]
    x, y = np.array([x, y]) / np.hypot(x, y)
    assert goes_sideways(moved, np.array([[x, y, 0.0], [-y, x, 0.0], [0.0, 0.0, 1.0]])) == (
        left > 0.0
    )


def test_who_hardly_travels_faces_right_whatever_he_does_later() -> None:
    """By the mean over a handstand, upside down for most of it, forward was to the left."""
    recording = load_recording("131_03_hop.bvh")
    character = build_character(recording)
    found = perform(recording, character)
    hips = {body.side: i for i, body in enumerate(character.bodies) if body.part is Part.THIGH}
    left = found.centres[0, hips[Side.LEFT]] - found.centres[0, hips[Side.RIGHT]]
    ahead = np.cross(left, UP)[:2]
    still = replace(found, com=found.com * [0.0, 0.0, 1.0], rotations=found.rotations.copy())
    around = axis_rotation(2, np.pi)
    still.rotations[60:] = around @ still.rotations[60:]
    motion = SimpleNamespace(duration=1.0, com=lambda times: np.zeros((len(times), 3)))
    fit = SimpleNamespace(performance=still)
    seen = np.array(heading(SimpleNamespace(fit=fit, motion=motion)))  # type: ignore[arg-type]
    assert seen @ ahead > 0.99 * np.linalg.norm(seen) * np.linalg.norm(ahead)


@cache
def as_recorded() -> Adaptation:
    return adapt(fitted_hop(), MotionProblem())


def with_contact(on: str | None, bone: str, height: float) -> Adaptation:
    """The hop with one more contact of a bone in its recording. height: m, of its place."""
    fit = as_recorded().fit
    first = fit.schedule.contacts[0]
    place = np.array([*first.place[:2], height])
    more = replace(first, name="More", point="More", bone=bone, place=place, on=on)
    schedule = replace(fit.schedule, contacts=(*fit.schedule.contacts, more))
    return replace(as_recorded(), fit=replace(fit, schedule=schedule))


@pytest.mark.slow
def test_a_foot_that_is_up_stands_on_a_step_and_a_hand_on_the_floor_does_not() -> None:
    for bone, steps in (("LeftHand", 0), ("LeftFoot", 1)):
        row = recorded_row(with_contact(None, bone, 0.07))
        (tier,) = lay_out([row]).tiers
        assert len(tier.steps) == steps
        assert len([mark for mark in row.marks if isinstance(mark, Sphere)]) == 1 - steps


@pytest.mark.slow
def test_the_recording_is_drawn_with_what_it_stood_on_and_nothing_else() -> None:
    scene = [thing(name, box((1.0, 1.0, 0.5))) for name in ("Crate", "Hurdle")]
    stood = with_contact("Crate", "LeftFoot", 0.5)
    (crate,) = recorded_on(stood, scene)
    assert isinstance(crate, Thing)
    assert recorded_on(as_recorded(), scene) == ()
    (tier,) = lay_out([recorded_row(stood, (crate,))]).tiers
    assert tier.steps == ()


def test_a_foot_on_a_wall_has_no_step() -> None:
    fit = SimpleNamespace(performance=hop().performance, schedule=hop().schedule)
    first, second, *_ = hop().schedule.contacts
    held = (PointContact(first, 0, normal=np.array([0.0, 1.0, 0.0])), PointContact(second, 1))
    motion = SimpleNamespace(transcription=SimpleNamespace(contacts=held))
    found = on_walls(SimpleNamespace(fit=fit, motion=motion))  # type: ignore[arg-type]
    assert found == {first.name}
    hold = ContactHold(Part.FOOT, np.zeros(3), (0.0, 1.0), grip=False)
    assert hold.stands
    assert not replace(hold, wall=True).stands


def test_hands_that_hold_on_are_at_a_bar_and_those_that_lean_on_the_floor_are_not() -> None:
    def drawn(grip: bool) -> list[Mark]:
        places = np.array([[0.3, 0.0, 0.05], [-0.3, 0.0, 0.05]])
        return list(bars([ContactHold(Part.HAND, each, (0.0, 1.0), grip) for each in places]))

    assert drawn(grip=False) == []
    (bar,) = drawn(grip=True)
    assert isinstance(bar, Bar)


@pytest.mark.parametrize(
    ("height", "grip", "post"),
    [(0.2, False, True), (0.07, False, False), (0.2, True, False), (1.5, False, False)],
)
def test_hands_that_rest_above_the_floor_have_a_post_below_the_palm(
    height: float, grip: bool, post: bool
) -> None:
    """Raised hands stood on nothing. Above the body they hang."""
    hold = ContactHold(Part.HAND, np.array([0.3, 0.1, height]), (0.0, 1.0), grip, depth=0.05)
    times, com = np.array([0.0, 1.0]), np.array([[0.0, 0.0, 0.9]] * 2)
    drawn = list(posts([hold], 0.0, times, com))
    assert len(drawn) == post
    assert list(posts([replace(hold, wall=True)], 0.0, times, com)) == []
    for each in drawn:
        np.testing.assert_allclose([each.start, each.end], [[0.3, 0.1, 0.0], [0.3, 0.1, 0.15]])
