"""Contacts that an adaptation wrote are not found anew in what is made from its result."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.solver.analysis.analyse import analyse
from hangtime.solver.contacts.known_contacts import Clock, with_known
from hangtime.solver.data.contacts import Contact, ContactPoint, KnownContacts, PointKind
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.fitting.fit import fit
from hangtime.solver.skeleton.mirror import mirrored
from hangtime.tests.helpers.clips import JUMP, load_recording

RATE = 100.0
FRAMES = np.arange(1.0, 202.0)
CLOCK = Clock(FRAMES, (FRAMES - 1.0) / RATE)


def point(wanders: float = 0.0) -> dict[str, ContactPoint]:
    track = np.zeros((len(FRAMES), 3))
    track[50, 0] = wanders
    return {"Left toe": ContactPoint(PointKind.TOE, "LeftToe", np.zeros(3), track)}


def contact(start: float, end: float) -> Contact:
    return Contact("Left toe", "Left toe", "LeftToe", np.zeros(3), start, end, np.zeros(3))


def spans(found: list[Contact], *known: KnownContacts, wanders: float = 0.0) -> list[object]:
    told = with_known(found, known, CLOCK, point(wanders), 2.0)
    return [(round(c.start, 6), round(c.end, 6)) for c in told]


def known(first: float, last: float, *contacts: tuple[float, float]) -> KnownContacts:
    return KnownContacts(first, last, tuple(("Left toe", *each) for each in contacts))


def test_what_is_known_counts_instead_of_what_is_found() -> None:
    assert spans([contact(0.15, 0.75)], known(1, 201, (21, 71))) == [(0.2, 0.7)]
    assert spans([contact(0.15, 0.2)], known(1, 201)) == []


def test_what_is_found_counts_beside_the_known_frames() -> None:
    found = [contact(0.0, 0.3), contact(1.5, 1.9)]
    assert spans(found, known(61, 121, (71, 111))) == [(0.0, 0.3), (0.7, 1.1), (1.5, 1.9)]


def test_a_contact_that_the_known_frames_cut_off_goes_on() -> None:
    assert spans([contact(0.1, 0.85)], known(51, 151, (51, 81))) == [(0.1, 0.8)]
    assert spans([contact(1.05, 1.8)], known(51, 151, (111, 151))) == [(1.1, 1.8)]


@pytest.mark.parametrize(("wanders", "counts"), [(0.02, True), (0.05, False)])
def test_frames_that_were_edited_since_are_looked_at(wanders: float, counts: bool) -> None:
    told = spans([contact(0.15, 0.75)], known(1, 201, (21, 71)), wanders=wanders)
    assert told == [(0.2, 0.7) if counts else (0.15, 0.75)]


@pytest.mark.parametrize(("end", "counts"), [(0.75, True), (0.95, False)])
def test_a_stance_that_was_made_longer_since_is_looked_at(end: float, counts: bool) -> None:
    told = spans([contact(0.2, end)], known(1, 201, (21, 71)))
    assert told == [(0.2, 0.7) if counts else (0.2, end)]
    assert spans([contact(0.2, end)], known(1, 201)) == [(0.2, end)]  # where a hop was taken out


def test_a_point_that_is_not_looked_at_is_left_out() -> None:
    other = KnownContacts(1, 201, (("Left knee", 1.0, 50.0),))
    assert with_known([contact(0.1, 0.15)], [other], CLOCK, point(), 2.0) == []


def test_a_mirrored_recording_has_them_on_the_other_side() -> None:
    each = KnownContacts(60, 330, (("Left toe", 60.0, 176.0), ("Right heel", 60.0, 134.0)))
    recording = replace(load_recording(JUMP), known=(each,))
    swapped = mirrored(recording).known[0].contacts
    assert swapped == (("Right toe", 60.0, 176.0), ("Left heel", 60.0, 134.0))


@pytest.mark.slow
def test_a_solved_jump_has_the_flight_that_it_was_solved_with() -> None:
    """Found anew it lasted 3.8 frames less, and 8 less after the next adaptation."""
    problem = MotionProblem(frames=(60.0, 330.0))
    first = analyse(load_recording(JUMP), problem)
    solved = fit(first.performance, first.schedule)
    recording, rate = first.performance.recording, first.performance.recording.rate
    assert solved.motion is not None
    track = solved.motion.track(recording)
    bones = [recording.index(bone) for bone in track.bones]
    rotations, heads = recording.rotations.copy(), recording.heads.copy()
    rotations[:, bones] = track.rotations
    posed = solved.motion.joint_centres(recording.times)
    heads[:, bones] = posed
    contacts = tuple(
        (c.point, 60.0 + c.start * rate, 60.0 + c.end * rate) for c in solved.schedule.contacts
    )
    written = replace(recording, rotations=rotations, heads=heads)
    known = replace(written, known=(KnownContacts(60.0, 330.0, contacts),))
    (was,), (now,) = solved.schedule.flights, analyse(known, problem).schedule.flights
    assert (now.start, now.end) == pytest.approx((was.start, was.end), abs=1e-3)
    (found,) = analyse(written, problem).schedule.flights
    assert found.end - found.start < was.end - was.start - 0.015  # why it must be known
