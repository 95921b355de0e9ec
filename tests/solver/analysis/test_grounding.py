"""Grounding: places on the floor, rises of soles, and time to step from place to place."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hangtime.solver.analysis import analyse as analyse_module
from hangtime.solver.analysis.analyse import analyse
from hangtime.solver.analysis.grounding import (
    MAX_STEP_SHARE,
    MAX_TILT,
    MIN_STEP_TIME,
    SAME_PLACE,
    SOLE_COMPLIANCE,
    disjoint,
    foot_sized,
    grounded,
    parted,
    rigid,
)
from hangtime.solver.analysis.performance import find_contacts
from hangtime.solver.contacts.events import numbered
from hangtime.solver.data.contacts import Contact, ContactSchedule, Interval
from hangtime.solver.data.problem import ContactEdit, MotionProblem
from hangtime.solver.numerics.rotations import unit
from hangtime.tests.helpers.clips import load_recording
from hangtime.tests.helpers.fitted_hop import hop


def found() -> ContactSchedule:
    return find_contacts(hop().performance)


def raised(schedule: ContactSchedule, height: float) -> ContactSchedule:
    up = np.array([0.0, 0.0, height])
    return replace(
        schedule, contacts=tuple(replace(c, place=c.place + up) for c in schedule.contacts)
    )


def overlapping(apart: float) -> ContactSchedule:
    """The first contact, and the same point once more from its middle until 0.2 s after its end."""
    first = found().contacts[0]
    place = first.place + np.array([apart, 0.0, 0.0])
    start = 0.5 * (first.start + first.end)
    again = replace(first, name=first.point, start=start, end=first.end + 0.2, place=place)
    return replace(found(), contacts=(first, again))


def test_one_point_is_in_one_place_at_a_time() -> None:
    first, again = overlapping(0.0).contacts
    (merged,) = disjoint(overlapping(0.5 * SAME_PLACE)).contacts
    assert (merged.start, merged.end) == (first.start, again.end)
    one, other = disjoint(overlapping(0.1)).contacts
    assert one.end == other.start == pytest.approx(0.5 * (again.start + first.end))
    kept = disjoint(found()).contacts
    assert [(c.name, c.start, c.end) for c in kept] == [
        (c.name, c.start, c.end) for c in found().contacts
    ]


def test_contacts_that_are_made_one_leave_no_gap_in_the_numbers(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Pins and corrections count the contacts that are told."""
    schedule = overlapping(0.5 * SAME_PLACE)
    later = replace(schedule.contacts[-1], start=0.9 * schedule.duration, end=schedule.duration)
    three = numbered((*schedule.contacts, later))
    monkeypatch.setattr(
        analyse_module, "find_contacts", lambda *_: replace(schedule, contacts=three)
    )
    recording = hop().performance.recording
    told = analyse(recording, MotionProblem()).schedule.contacts
    assert [c.name for c in told] == [f"{later.point} {i}" for i in (1, 2)]
    removed = MotionProblem(contacts=(ContactEdit(told[1].name, remove=True),))
    (left,) = analyse(recording, removed).schedule.contacts
    assert left.end == told[0].end


def test_places_near_the_floor_are_put_upon_it() -> None:
    for c in grounded(raised(found(), 0.01), hop().performance).contacts:
        assert abs(c.place[2] - found().floor_m) <= 0.002


def test_places_on_a_box_stay_there() -> None:
    high = raised(found(), 0.3)
    kept = grounded(high, hop().performance).contacts
    for before, after in zip(high.contacts, kept, strict=True):
        assert after.place == pytest.approx(before.place)


def test_soles_give_where_the_body_lands_and_leaves_but_not_at_the_clip_s_ends() -> None:
    schedule = grounded(found(), hop().performance)
    for c in schedule.contacts:
        assert all(0.0 <= rise <= SOLE_COMPLIANCE for rise in c.rise)
        if c.start == 0.0:
            assert c.rise[0] == 0.0
        if c.end == schedule.duration:
            assert c.rise[1] == 0.0
    assert max(max(c.rise) for c in schedule.contacts) > 0.5 * SOLE_COMPLIANCE


def cut(schedule: ContactSchedule, apart: float) -> tuple[ContactSchedule, Contact]:
    """One toe's contact cut in two whose places are `apart` m; the other foot carries on."""
    index = next(i for i, c in enumerate(schedule.contacts) if c.end - c.start > 0.3)
    whole = schedule.contacts[index]
    middle = 0.5 * (whole.start + whole.end)
    aside = whole.place + np.array([apart, 0.0, 0.0])
    halves = (replace(whole, end=middle), replace(whole, start=middle, place=aside))
    contacts = (*schedule.contacts[:index], *halves, *schedule.contacts[index + 1 :])
    return replace(schedule, contacts=contacts), whole


def halves_of(whole: Contact, schedule: ContactSchedule) -> tuple[Contact, Contact]:
    first, second = [
        c
        for c in schedule.contacts
        if c.point == whole.point and c.start < whole.end and c.end > whole.start
    ]
    return first, second


def test_a_foot_that_slides_gets_time_to_step() -> None:
    schedule, whole = cut(found(), 0.08)
    first, second = halves_of(whole, parted(schedule))
    assert second.start - first.end >= MIN_STEP_TIME
    assert 0.5 * (first.end + second.start) == pytest.approx(0.5 * (whole.start + whole.end))


def test_a_foot_that_stays_keeps_its_times_and_stands_on_one_place() -> None:
    schedule, whole = cut(found(), 0.9 * SAME_PLACE)
    first, second = halves_of(whole, parted(schedule))
    assert first.end == second.start == 0.5 * (whole.start + whole.end)
    assert second.place == pytest.approx(first.place)


def test_a_foot_that_carries_alone_skids_while_something_unseen_carries() -> None:
    alone, whole = cut(replace(found(), contacts=found().contacts[:1]), 0.08)
    skidding = parted(alone)
    first, second = halves_of(whole, skidding)
    assert second.start - first.end == pytest.approx(0.08)
    assert second.place - first.place == pytest.approx([0.08, 0.0, 0.0])
    assert skidding.unseen == (*alone.unseen, Interval(first.end, second.start))
    assert skidding.phases == alone.phases


def test_three_places_in_a_row_leave_none_in_two_at_once() -> None:
    alone, whole = cut(replace(found(), contacts=found().contacts[:1]), 0.08)
    first, last = halves_of(whole, alone)
    brief = replace(first, start=first.end - 0.05, place=whole.place - [0.05, 0.0, 0.0])
    row = (replace(first, end=brief.start), brief, last)
    for one, other in pairwise(parted(replace(alone, contacts=row)).contacts):
        assert one.end < other.start
        assert other.end - other.start >= 0.4 * 0.05


def test_what_is_on_another_thing_keeps_its_place() -> None:
    """Places on ground that moves are told as seen from it."""
    schedule, whole = cut(found(), 0.08)
    first, second = halves_of(whole, schedule)
    onto = replace(second, on="Train")
    contacts = tuple(onto if c is second else c for c in schedule.contacts)
    assert halves_of(whole, parted(replace(schedule, contacts=contacts))) == (first, onto)


def test_a_step_is_made_when_something_else_carries() -> None:
    """The other foot stands from the middle on, so the step is all after it."""
    alone, whole = cut(replace(found(), contacts=found().contacts[:1]), 0.08)
    first, second = halves_of(whole, alone)
    other = replace(second, name="Right toe 1", point="Right toe", place=whole.place + 0.3)
    before, after = halves_of(whole, parted(replace(alone, contacts=(first, second, other))))
    assert before.end == first.end
    assert after.start - second.start == pytest.approx(MAX_STEP_SHARE * (second.end - second.start))


def test_the_artist_s_times_are_not_shifted() -> None:
    """The recording's left toe slides by 8 cm as it stands, so its contacts are parted."""
    recording = load_recording("fair1_jumping.bvh")
    before, after = left_toes(analyse(recording, MotionProblem()).schedule)
    assert after.start - before.end >= MIN_STEP_TIME
    middle = 0.5 * (before.end + after.start) * recording.rate + recording.frames[0]
    edits = (ContactEdit(after.name, start_frame=round(middle)),)
    edited, put = left_toes(analyse(recording, MotionProblem(contacts=edits)).schedule)
    asked = (round(middle) - recording.frames[0]) / recording.rate
    assert put.start == pytest.approx(asked)
    assert edited.end == pytest.approx(before.end)


def left_toes(schedule: ContactSchedule) -> tuple[Contact, Contact]:
    """The two that follow each other at once."""
    toes = [c for c in schedule.contacts if c.point == "Left toe"]
    pairs = [(a, b) for a, b in pairwise(toes) if b.start - a.end < 0.2]
    (only,) = pairs
    return only


def heel_and_toe() -> tuple[int, int]:
    """A heel's contact and its toe's, which lasts longer and meanwhile stands."""
    contacts = found().contacts
    return next(
        (i, j)
        for i, heel in enumerate(contacts)
        for j, toe in enumerate(contacts)
        if (heel.point, toe.point) == ("Left heel", "Left toe")
        and toe.end - toe.start > heel.end - heel.start
        and min(heel.end, toe.end) - max(heel.start, toe.start) > 0.05
    )


def test_a_heel_goes_with_the_toe_whose_place_is_of_another_moment() -> None:
    heel, toe = heel_and_toe()
    contacts = list(found().contacts)
    turned_away = contacts[toe].place + np.array([0.1, 0.0, 0.0])
    contacts[toe] = replace(contacts[toe], place=turned_away)
    turned = replace(found(), contacts=tuple(contacts))
    sized = foot_sized(turned, hop().performance).contacts
    assert sized[toe].place == pytest.approx(turned_away)
    moved = sized[heel].place - contacts[heel].place
    assert moved == pytest.approx([0.1, 0.0, 0.0], abs=0.01)


def test_a_toe_that_goes_with_a_heel_takes_its_other_heel_along() -> None:
    """Of a foot that is put down twice: the second time for longest, and elsewhere."""
    heel, toe = (found().contacts[i] for i in heel_and_toe())
    span = max(0.0, toe.start - 0.1), min(found().duration, toe.end + 0.1)
    ahead = 0.1 * unit((toe.place - heel.place) * [1.0, 1.0, 0.0])
    elsewhere = heel.place + ahead
    second = replace(heel, name="Left heel 9", start=span[0], end=span[1], place=elsewhere)
    turned = replace(found(), contacts=(heel, toe, second))
    first, between, last = foot_sized(turned, hop().performance).contacts
    assert last.place == pytest.approx(elsewhere)
    assert between.place - toe.place == pytest.approx(ahead, abs=0.01)
    assert first.place - heel.place == pytest.approx(ahead, abs=0.01)


def test_places_of_a_foot_that_stands_still_stay() -> None:
    standing = found()
    kept = foot_sized(standing, hop().performance).contacts
    assert all(a.place is b.place for a, b in zip(kept, standing.contacts, strict=True))


def test_points_of_one_bone_keep_their_distance() -> None:
    """A foot without toes turns about its heel: two places of the toe, each of another moment."""
    base = found().contacts[0]
    offset = base.offset + np.array([0.0, 0.2, 0.0])
    heel = replace(base, start=0.0, end=0.9)
    ahead, aside = np.array([0.19, 0.0, 0.0]), np.array([0.0, 0.22, 0.003])
    first = replace(base, point="Toe", offset=offset, start=0.0, end=0.3, place=base.place + ahead)
    second = replace(first, start=0.5, end=1.0, place=base.place + aside)
    settled = rigid(replace(found(), contacts=(heel, first, second))).contacts
    for toe in settled[1:]:
        assert np.linalg.norm(toe.place - settled[0].place) == pytest.approx(0.2, abs=1e-5)
    assert [c.place[2] for c in settled] == [c.place[2] for c in (heel, first, second)]
    stays, goes = rigid(replace(found(), contacts=(heel, first))).contacts
    assert goes.place[0] - first.place[0] == pytest.approx(3.0 * (heel.place[0] - stays.place[0]))


def test_a_foot_without_toes_lands_level_and_tilts_little_beside_what_stands() -> None:
    landing = next(c for c in found().contacts if c.start > 0.0)
    (free,) = grounded(replace(found(), contacts=(landing,)), hop().performance).contacts
    assert free.rise[0] > MAX_TILT
    offset = landing.offset + np.array([0.0, 0.1, 0.0])
    ahead = replace(landing, point="Ahead", offset=offset)
    for later, most in ((1e-12, SOLE_COMPLIANCE), (0.01, MAX_TILT)):
        both = (landing, replace(ahead, start=landing.start + later))
        first, second = grounded(replace(found(), contacts=both), hop().performance).contacts
        assert 0.0 <= second.rise[0] <= most
        assert first.rise[0] == second.rise[0] or later > 1e-9
