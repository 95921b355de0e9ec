"""The move of the last stance, with which the rest of a take goes."""

from __future__ import annotations

from math import radians

import numpy as np
import pytest
from hangtime.solver.arrays import FloatArray
from hangtime.solver.data.contacts import Contact, ContactSchedule
from hangtime.solver.data.problem import MotionProblem, Pin
from hangtime.solver.numerics.rotations import axis_rotation
from hangtime.solver.results.last_stance import last_stance_move
from hangtime.solver.stages.implicit import adapt
from hangtime.solver.stages.warm_start import RigidMove, Standing, end_move, stance_moves
from hangtime.tests.helpers.fitted_hop import fitted_hop


def test_what_nobody_moves_stays_to_the_last_bit() -> None:
    move = last_stance_move(adapt(fitted_hop(), MotionProblem()))
    assert move is not None
    assert move.stays
    assert move.shift == (0.0, 0.0, 0.0)


def test_a_landing_that_is_moved_and_turned_takes_the_rest_along() -> None:
    pin = Pin("Landing", "ground 2", (), offset=(0.1, 0.05, 0.0), turn=radians(20.0))
    adaptation = adapt(fitted_hop(), MotionProblem(pins=(pin,)))
    move = last_stance_move(adaptation)
    assert move is not None
    assert move.phase == "ground 2"
    assert move.turn == pytest.approx(radians(20.0), abs=1e-9)
    assert np.hypot(*move.shift[:2]) == pytest.approx(np.hypot(0.1, 0.05), abs=1e-9)
    assert move.shift[2] == pytest.approx(0.0, abs=1e-9)
    assert not move.stays
    assert move.scaled(2.0).shift == pytest.approx(np.multiply(2.0, move.shift))


@pytest.mark.slow
def test_a_motion_short_of_its_target_takes_the_rest_along_as_far_as_it_goes() -> None:
    pin = Pin("Landing", "ground 2", offset=(0.0, 0.0, 3.0))
    adaptation = adapt(fitted_hop(), MotionProblem(pins=(pin,)))
    move = last_stance_move(adaptation)
    assert move is not None
    assert 0.0 < adaptation.reached < 1.0
    assert move.shift[2] == pytest.approx(3.0 * adaptation.reached, rel=0.01)


def standing(*ends: float) -> ContactSchedule:
    """One stance of 1 s, of contacts that begin at once, 0.2 m apart along x."""
    places = np.column_stack([0.2 * np.arange(len(ends)), np.zeros((len(ends), 2))])
    contacts = tuple(
        Contact(f"toe {k} 1", f"toe {k}", "toe", np.zeros(3), 0.0, end, place)
        for k, (end, place) in enumerate(zip(ends, places, strict=True))
    )
    return ContactSchedule(contacts, 1.0, 0.0)


def test_what_follows_goes_with_what_stands_at_the_end() -> None:
    """A foot that stepped on was moved otherwise."""
    schedule = standing(0.5, 1.0, 1.0)
    before = np.array([contact.place for contact in schedule.contacts])
    after = before + np.array([[0.0, 0.3, 0.0], [0.1, 0.0, 0.0], [0.1, 0.0, 0.0]])
    standings = Standing.still(before), Standing.still(after)
    [whole] = stance_moves(schedule, *standings)
    last = end_move(schedule, *standings, whole)
    assert whole.turns[-1] != pytest.approx(0.0, abs=0.1)
    assert last.turns[-1] == pytest.approx(0.0, abs=1e-9)
    assert last.shifts[-1] == pytest.approx((0.1, 0.0, 0.0))


def test_one_foot_turns_as_the_stance() -> None:
    schedule = standing(0.5, 0.5, 1.0)
    before = np.array([contact.place for contact in schedule.contacts])
    after = before @ axis_rotation(2, 0.4).T
    standings = Standing.still(before), Standing.still(after)
    [whole] = stance_moves(schedule, *standings)
    last = end_move(schedule, *standings, whole)
    assert last.turns[-1] == pytest.approx(0.4)
    assert last.pivots[-1] == pytest.approx(before[2])
    assert last.pivots[-1] + last.shifts[-1] == pytest.approx(after[2])


def two_feet(left: float, right: float) -> ContactSchedule:
    """That stand where a stance of 1 s ends, since these times, s; 0.8 m apart along y."""
    contacts = [
        Contact(f"{side} {part} 1", f"{side} {part}", part, np.zeros(3), start, 1.0, place)
        for side, start, y in (("Left", left, 0.0), ("Right", right, 0.8))
        for part, place in (
            ("heel", np.array([0.0, y, 0.0])),
            ("toe", np.array([0.0, y + 0.15, 0.0])),
        )
    ]
    return ContactSchedule(tuple(contacts), 1.0, 0.0)


def moved_at_end(schedule: ContactSchedule, after: FloatArray) -> RigidMove:
    before = np.array([contact.place for contact in schedule.contacts])
    standings = Standing.still(before), Standing.still(after)
    return end_move(schedule, *standings, stance_moves(schedule, *standings)[-1])


@pytest.mark.parametrize("aside", [0.08, 0.2])
@pytest.mark.parametrize("left", [0.0, 0.3])  # with the other foot, and before it
def test_a_step_aside_leaves_what_follows_to_the_foot_that_stays(left: float, aside: float) -> None:
    """The least-squares move of both feet turned a walk by 17 degrees and dragged this foot."""
    schedule = two_feet(left, left if left == 0.0 else 0.7)
    after = np.array([contact.place for contact in schedule.contacts])
    after[:2, 0] += aside
    move = moved_at_end(schedule, after)
    assert move.turns[-1] == 0.0
    assert move.shifts[-1] == pytest.approx(0.0, abs=1e-12)


def test_what_follows_goes_with_the_foot_that_came_down_last_and_stands_the_longest() -> None:
    schedule = two_feet(0.3, 0.7)
    after = np.array([contact.place for contact in schedule.contacts])
    after[2:, 0] += 0.2  # the later one
    move = moved_at_end(schedule, after)
    assert move.turns[-1] == pytest.approx(0.0, abs=1e-12)
    assert move.shifts[-1] == pytest.approx((0.2, 0.0, 0.0))


def test_feet_that_part_in_a_landing_that_is_turned_leave_it_turned() -> None:
    schedule = two_feet(0.0, 0.0)
    after = np.array([contact.place for contact in schedule.contacts]) @ axis_rotation(2, 2.0).T
    after[:2] += (0.1, 0.1, 0.0)
    move = moved_at_end(schedule, after)
    assert move.turns[-1] == pytest.approx(2.0)
    left = schedule.contacts[0].place[None]  # is moved less than the other, which turns farther off
    assert move.of(left, np.ones(1))[0] == pytest.approx(after[0])
