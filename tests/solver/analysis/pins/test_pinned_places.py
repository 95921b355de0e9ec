"""Pins: which contacts they move and where to, and which cannot be held together."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.solver.analysis.analyse import analyse
from hangtime.solver.analysis.pins.pinned_places import (
    FURTHEST,
    backward_stances,
    chosen_contacts,
    pinned_places,
    travel_axes,
)
from hangtime.solver.arrays import FloatArray
from hangtime.solver.contacts.events import numbered
from hangtime.solver.contacts.footfalls import footfalls
from hangtime.solver.data.contacts import Contact, ContactSchedule, Touch
from hangtime.solver.data.faults import (
    BesideFrames,
    BeyondPrecision,
    ContradictoryPins,
    UnknownContact,
    UnknownContactName,
    UnknownPhase,
)
from hangtime.solver.data.problem import AddedContact, ContactEdit, MotionProblem, OffsetAxes, Pin
from hangtime.solver.data.requests import Vector
from hangtime.tests.helpers.clips import load_recording
from hangtime.tests.helpers.fitted_hop import HOP, HOP_CLIP, frames_of, hop

LANDING = "ground 2"
UP = np.array([0.0, 0.0, 1.0])


def before() -> FloatArray:
    return np.stack([c.place for c in hop().schedule.contacts])


def after(*pins: Pin) -> FloatArray:
    return pinned_places(MotionProblem(pins=pins), hop().performance, hop().schedule)


def landing() -> FloatArray:
    """(n_contacts,) bool: which contacts belong to the landing."""
    schedule = hop().schedule
    phase = next(p for p in schedule.phases if p.name == LANDING)
    mine = {c.name for c in schedule.of_phase(phase)}
    return np.array([c.name in mine for c in schedule.contacts])


def of_bone(bone: str) -> FloatArray:
    return np.array([c.bone == bone for c in hop().schedule.contacts])


def test_no_pins_leave_every_contact() -> None:
    assert after() == pytest.approx(before())


def test_a_phase_s_pin_moves_all_of_its_contacts_and_no_others() -> None:
    shift = np.array([0.3, -0.1, 0.2])
    moved = after(Pin("landing", LANDING, offset=tuple(shift), axes=OffsetAxes.WORLD)) - before()
    here = landing()
    assert 0 < here.sum() < len(here)
    assert moved[here] == pytest.approx(np.tile(shift, (here.sum(), 1)))
    assert not moved[~here].any()


def test_travel_axes_follow_the_flight() -> None:
    performance, schedule = hop().performance, hop().schedule
    phase = next(p for p in schedule.phases if p.name == LANDING)
    axes = travel_axes(performance, schedule, phase)
    assert axes.T @ axes == pytest.approx(np.eye(3), abs=1e-12)
    assert np.linalg.det(axes) == pytest.approx(1.0)
    assert axes[:, 2] == pytest.approx(UP)
    flight = schedule.flights[0]
    ahead = performance.com[np.searchsorted(performance.times, flight.end)]
    ahead = ahead - performance.com[np.searchsorted(performance.times, flight.start)]
    assert axes[:2, 0] @ ahead[:2] > 0.99 * np.linalg.norm(ahead[:2])
    moved = (after(Pin("further", LANDING, offset=(0.3, 0.0, 0.2))) - before())[landing()]
    assert moved == pytest.approx(np.tile(0.3 * axes[:, 0] + 0.2 * UP, (len(moved), 1)))


def test_on_the_spot_ahead_is_where_the_body_faces() -> None:
    """A jump that goes nowhere still has a forward: at right angles to the hips."""
    analysis = hop()
    performance = analysis.performance
    still = replace(performance, com=performance.com * [0.0, 0.0, 1.0])
    phase = next(p for p in analysis.schedule.phases if p.name == LANDING)
    faces = travel_axes(still, analysis.schedule, phase)[:, 0]
    travels = travel_axes(performance, analysis.schedule, phase)[:, 0]
    assert faces @ travels > 0.9  # these hops go straight ahead
    flight = analysis.schedule.flights[0]
    back = -0.1 / (flight.end - flight.start) * performance.times[:, None] * travels
    drifting = replace(performance, com=still.com + back)  # 0.1 m backwards in its flight
    assert travel_axes(drifting, analysis.schedule, phase)[:, 0] == pytest.approx(faces)


def test_of_a_jump_backwards_forward_is_at_the_bodys_back() -> None:
    performance, schedule = hop().performance, hop().schedule
    assert backward_stances(performance, schedule) == ()
    back, left = np.diag([-1.0, -1.0, 1.0]), np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1]])
    backwards = replace(performance, com=performance.com @ back)
    assert LANDING in backward_stances(backwards, schedule)
    assert backward_stances(replace(performance, com=performance.com @ left), schedule) == ()


def test_places_are_for_the_contacts_centre() -> None:
    goal = (1.0, 2.0, 0.5)
    moved = after(Pin("there", LANDING, place=goal))[landing()]
    assert moved.mean(axis=0) == pytest.approx(goal)
    shape = before()[landing()]
    assert moved - moved.mean(axis=0) == pytest.approx(shape - shape.mean(axis=0))
    added = Pin("there", LANDING, place=goal, offset=(0.1, 0.0, 0.0), axes=OffsetAxes.WORLD)
    assert after(added)[landing()].mean(axis=0) == pytest.approx([1.1, 2.0, 0.5])


def test_turns_are_counter_clockwise_about_the_contacts_centre() -> None:
    old = before()[landing()]
    new = after(Pin("turned", LANDING, turn=np.pi / 2))[landing()]
    a, b = old - old.mean(axis=0), new - old.mean(axis=0)
    assert b == pytest.approx(np.stack([-a[:, 1], a[:, 0], a[:, 2]], axis=1), abs=1e-12)


@pytest.mark.parametrize("pick", ["bone", "point", "name"])
def test_one_foot_is_chosen_by_bone_point_or_contact(pick: str) -> None:
    schedule, here = hop().schedule, landing()
    left = [
        c for c, mine in zip(schedule.contacts, here, strict=True) if mine and "Left" in c.point
    ]
    touching = tuple({getattr(c, pick) for c in left})
    pin = Pin("left", LANDING, touching=touching, offset=(0.0, 0.1, 0.0))
    moved = np.linalg.norm(after(pin) - before(), axis=1) > 1e-6
    names = {c.name for c in left}
    assert {c.name for c, m in zip(schedule.contacts, moved, strict=True) if m} == names


def test_one_footfall_is_chosen_by_any_of_its_contacts() -> None:
    """A walk's heel and toe of one step are numbered apart, for the toe began the clip."""
    points = ["Left toe", "Right heel", "Left heel", "Left toe", "Left hand", "Left heel"]
    spans = [(0.0, 0.3), (0.0, 0.6), (0.5, 0.9), (0.6, 1.2), (0.8, 1.7), (1.6, 2.0)]
    walk = ContactSchedule(
        numbered(
            Contact("", point, point.replace(" ", ""), np.zeros(3), *span, np.zeros(3))
            for point, span in zip(points, spans, strict=True)
        ),
        2.0,
        0.0,
    )
    (phase,) = walk.stances
    for step, meant in (
        ("Left heel 1", {"Left heel 1", "Left toe 2"}),
        ("Left toe 2", {"Left heel 1", "Left toe 2"}),
        ("Left toe 1", {"Left toe 1"}),
        ("Left heel 2", {"Left heel 2"}),
        ("Left hand 1", {"Left hand 1"}),
    ):
        chosen = chosen_contacts(Pin("step", "ground 1", step=step), phase, walk)
        assert {walk.contacts[i].name for i in chosen} == meant
    with pytest.raises(UnknownContact) as caught:
        chosen_contacts(Pin("step", "ground 1", step="Left heel 3"), phase, walk)
    assert "Left heel 2" in caught.value.known


def test_a_footfall_is_what_of_a_foot_touches_at_once_or_rolls_on() -> None:
    heel, toe = "Left heel", "Left toe"
    rolls = [Touch(heel, 10.0, 14.0), Touch(toe, 14.0, 20.0), Touch("Right toe", 12.0, 30.0)]
    assert footfalls(rolls) == ((0, 1), (2,))
    slides = [Touch(toe, 10.0, 14.0), Touch(toe, 14.0, 20.0)]  # to another place
    assert footfalls(slides) == ((0,), (1,))
    again = [Touch(heel, 10.0, 14.0), Touch(toe, 12.0, 20.0), Touch(heel, 25.0, 30.0)]
    assert footfalls(again) == ((0, 1), (2,))


def test_unknown_phases_are_named_with_those_there_are() -> None:
    with pytest.raises(UnknownPhase) as caught:
        after(Pin("landing", "ground 7"))
    assert (caught.value.pin, caught.value.phase) == ("landing", "ground 7")
    assert caught.value.known == ("ground 1", "ground 2")
    with pytest.raises(UnknownPhase):
        after(Pin("landing", "flight 1"))  # nothing touches there


def test_unknown_contacts_are_named_with_those_there_are() -> None:
    with pytest.raises(UnknownContact) as caught:
        after(Pin("landing", LANDING, touching=("LeftHand",)))
    assert (caught.value.pin, caught.value.what) == ("landing", "LeftHand")
    assert "LeftFoot" in caught.value.known


def test_two_pins_for_one_contact_contradict_each_other_by_their_distance() -> None:
    first = Pin("far", LANDING, offset=(0.3, 0.0, 0.0))
    second = Pin("further", LANDING, offset=(0.3, 0.0, 0.25))
    with pytest.raises(ContradictoryPins) as caught:
        after(first, second)
    assert {caught.value.first, caught.value.second} == {"far", "further"}
    assert caught.value.metres == pytest.approx(0.25)


@pytest.mark.parametrize("where", [{"offset": (1e7, 0.0, 0.0)}, {"place": (0.0, 2e3, 0.0)}])
def test_a_pin_that_moves_too_far_to_compute_is_refused_by_name(where: dict[str, Vector]) -> None:
    with pytest.raises(BeyondPrecision) as caught:
        after(Pin("Landing", LANDING, **where))
    assert caught.value.request == "Landing"
    assert caught.value.metres > FURTHEST


def test_a_whole_jump_may_be_elsewhere() -> None:
    moved = after(Pin("a", LANDING, offset=(0.9 * FURTHEST, 0.0, 0.0)))
    assert np.linalg.norm(moved - before(), axis=1).max() == pytest.approx(0.9 * FURTHEST)


def test_two_pins_that_agree_are_one() -> None:
    """What is asked for is where to, from the recording; not one move after another."""
    once = after(Pin("a", LANDING, offset=(0.3, 0.0, 0.0)))
    twice = after(
        Pin("a", LANDING, offset=(0.3, 0.0, 0.0)), Pin("b", LANDING, offset=(0.3, 0.0, 0.0))
    )
    assert twice == pytest.approx(once)


def test_heel_and_toe_of_one_foot_cannot_part() -> None:
    heel = next(
        c
        for c, mine in zip(hop().schedule.contacts, landing(), strict=True)
        if mine and c.point == "Left heel"
    )
    with pytest.raises(ContradictoryPins) as caught:
        after(Pin("heel", LANDING, touching=(heel.point,), offset=(-0.2, 0.0, 0.0)))
    assert "heel" in {caught.value.first, caught.value.second}
    assert caught.value.metres == pytest.approx(0.2, abs=0.05)


def test_feet_may_part() -> None:
    left = Pin("left", LANDING, touching=("LeftFoot", "LeftToeBase"), offset=(0.0, 0.1, 0.0))
    right = Pin("right", LANDING, touching=("RightFoot", "RightToeBase"), offset=(0.2, -0.1, 0.0))
    moved = np.linalg.norm(after(left, right) - before(), axis=1)[landing()]
    assert moved.min() > 0.09


def test_contacts_are_corrected_by_name() -> None:
    contact = hop().schedule.contacts[-1]
    frames = frames_of(HOP_CLIP, HOP)
    end = frames[0] + round(0.9 * (frames[1] - frames[0]))
    problem = MotionProblem(frames=frames, contacts=(ContactEdit(contact.name, end_frame=end),))
    edited = analyse(load_recording(HOP_CLIP), problem)
    mine = next(c for c in edited.schedule.contacts if c.name == contact.name)
    rate = (len(edited.performance.times) - 1) / edited.performance.times[-1]
    assert mine.end == pytest.approx((end - frames[0]) / rate, abs=0.0125)
    gone = replace(problem, contacts=(ContactEdit(contact.name, remove=True),))
    names = [c.name for c in analyse(load_recording(HOP_CLIP), gone).schedule.contacts]
    assert contact.name not in names


def test_unknown_corrections_are_named() -> None:
    problem = MotionProblem(
        frames=frames_of(HOP_CLIP, HOP), contacts=(ContactEdit("Left ear 1", remove=True),)
    )
    with pytest.raises(UnknownContactName) as caught:
        analyse(load_recording(HOP_CLIP), problem)
    assert caught.value.name == "Left ear 1"
    assert "Left toe 1" in caught.value.known


def test_contacts_to_add_beside_the_frames_are_refused() -> None:
    first, last = frames_of(HOP_CLIP, HOP)
    beside = AddedContact("Left hand", last + 10.0, last + 20.0)
    with pytest.raises(BesideFrames) as caught:
        analyse(load_recording(HOP_CLIP), MotionProblem(frames=(first, last), added=(beside,)))
    assert caught.value == BesideFrames("Left hand", last + 10.0, first, last)
