"""A stance is what stands together, also where something unseen carries from one to the next."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.solver.data.contacts import ContactSchedule, Interval
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.solver.stages.warm_start import Standing, stance_moves
from hangtime.tests.helpers.fitted_hop import hop

TURN = np.radians(30.0)


def carried() -> ContactSchedule:
    """The hop's contacts with its flight carried by something unseen: one phase on the ground."""
    schedule = hop().schedule
    (flight,) = schedule.flights
    return replace(schedule, unseen=(Interval(flight.start, flight.end),))


def landed(schedule: ContactSchedule) -> list[int]:
    """Indices of the contacts behind the flight."""
    (unseen,) = schedule.unseen
    return [i for i, c in enumerate(schedule.contacts) if c.start >= unseen.end]


def test_a_stance_of_one_point_turns_as_it_is_wished() -> None:
    """Its place tells nothing of it; it stood between two that turned, unturned."""
    schedule = carried()
    lone, *rest = landed(schedule)
    places = np.array([c.place for c in schedule.contacts])
    contacts = tuple(c for i, c in enumerate(schedule.contacts) if i not in rest)
    standing = Standing.still(np.delete(places, rest, axis=0))
    wanted = {schedule.contacts[lone].name: TURN}
    _, landing = stance_moves(replace(schedule, contacts=contacts), standing, standing, wanted)
    assert np.allclose(landing.turns, TURN)


@pytest.mark.parametrize("whole", [0.0, 2.0 * np.pi])
def test_a_landing_behind_what_is_unseen_moves_by_itself(whole: float) -> None:
    """whole: rad, of a turn that places do not tell; it is the landing's alone."""
    schedule = carried()
    assert len(schedule.phases) == 1
    mine = landed(schedule)
    places = np.array([c.place for c in schedule.contacts])
    moved, middle = places.copy(), places[mine].mean(axis=0)
    moved[mine] = middle + (places[mine] - middle) @ axis_rotation(2, np.array([TURN]))[0].T
    wanted = {schedule.contacts[i].name: TURN + whole for i in mine}
    before, after = Standing.still(places), Standing.still(moved)
    take_off, landing = stance_moves(schedule, before, after, wanted)
    assert np.allclose(take_off.turns, 0.0)
    assert np.allclose(landing.turns, TURN + whole)
    assert np.allclose(landing.shifts, 0.0)
