"""Grounding: places on the floor, rises of soles, and time to step from place to place."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.solver.analysis.grounding import MIN_STEP_TIME, SOLE_COMPLIANCE, grounded
from hangtime.solver.analysis.performance import find_contacts
from hangtime.solver.data.contacts import ContactSchedule
from hangtime.tests.helpers.fitted_hop import hop


def found() -> ContactSchedule:
    return find_contacts(hop().performance)


def raised(schedule: ContactSchedule, height: float) -> ContactSchedule:
    up = np.array([0.0, 0.0, height])
    return replace(
        schedule, contacts=tuple(replace(c, place=c.place + up) for c in schedule.contacts)
    )


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


def test_a_foot_that_slides_gets_time_to_step() -> None:
    """One toe's contact is cut in two whose places are 8 cm apart; the other foot carries on."""
    schedule = found()
    index = next(i for i, c in enumerate(schedule.contacts) if c.end - c.start > 0.3)
    whole = schedule.contacts[index]
    middle = 0.5 * (whole.start + whole.end)
    aside = whole.place + np.array([0.08, 0.0, 0.0])
    halves = (replace(whole, end=middle), replace(whole, start=middle, place=aside))
    contacts = (*schedule.contacts[:index], *halves, *schedule.contacts[index + 1 :])
    first, second = [
        c
        for c in grounded(replace(schedule, contacts=contacts), hop().performance).contacts
        if c.point == whole.point and c.start < whole.end and c.end > whole.start
    ]
    assert second.start - first.end >= MIN_STEP_TIME
    assert 0.5 * (first.end + second.start) == pytest.approx(middle)
