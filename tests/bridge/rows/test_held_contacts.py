"""Contacts found again by another analysis."""

from dataclasses import replace
from math import nan

import pytest
from hangtime.bridge.rows.held_contacts import HeldContact, found_again, frame_of, movers

METRE = 1.0


def contact(point: str, start: float, end: float, x: float) -> HeldContact:
    """A contact of ground 2 as it was found, unchanged."""
    at = (x, 0.0, 0.0)
    name, frames = f"{point} 1", (start, end, start, end)
    return HeldContact(name, point, "", "ground 2", False, True, None, None, *frames, at, at)


LEFT, RIGHT = contact("Left toe", 100.0, 140.0, 1.0), contact("Right toe", 104.0, 141.0, 1.1)
MOVED = replace(LEFT, at=(1.2, 0.0, 0.0))


def shifted(held: HeldContact, frames: float, x: float) -> HeldContact:
    start, end = held.found_start + frames, held.found_end + frames
    at = (held.found_at[0] + x, 0.0, 0.0)
    return replace(held, found_start=start, found_end=end, found_at=at, at=at)


@pytest.mark.parametrize("frames", [0.0, 60.0])
@pytest.mark.parametrize("x", [0.05, 50.0])
def test_a_take_that_is_elsewhere_or_later_has_the_same_contacts(frames: float, x: float) -> None:
    held = [MOVED, RIGHT]
    rows = [shifted(each, frames, x) for each in held]
    again = found_again(rows, held, METRE)
    assert again.contacts == {0: MOVED, 1: RIGHT}
    assert again.displacement.later == frames
    assert again.displacement.place((0.0, 0.0, 0.0)) == pytest.approx((x, 0.0, 0.0))
    along = again.displacement.contact(LEFT)
    assert along.start_frame == LEFT.start_frame + frames
    assert along.at == pytest.approx((1.0 + x, 0.0, 0.0))


def test_a_take_that_is_turned_has_its_moves_turned() -> None:
    held = [MOVED, contact("Left toe", 200.0, 240.0, 9.0)]
    rows = [replace(each, found_at=(0.0, each.found_at[0], 0.0)) for each in held]
    again = found_again(rows, held, METRE)
    assert set(again.contacts) == {0, 1}
    assert again.displacement.direction(MOVED.move) == pytest.approx((0.0, 0.2, 0.0))


def test_of_another_take_those_near_by_at_the_same_time_are_the_same() -> None:
    rows = [contact("Right toe", 20.0, 60.0, 0.0), shifted(LEFT, 3.0, 0.1)]
    assert found_again(rows, [MOVED, RIGHT], METRE).contacts == {1: MOVED}
    assert not found_again(rows, [MOVED, RIGHT], 0.01).contacts  # 10 cm are ten units there


def test_a_range_that_is_moved_by_a_cycle_leaves_the_steps_their_own() -> None:
    steps = [contact("Left toe", 100.0 + 40.0 * k, 120.0 + 40.0 * k, 1.0 * k) for k in range(5)]
    held = [steps[0], replace(steps[1], at=(1.2, 0.0, 0.0)), steps[2]]
    again = found_again(steps[1:4], held, METRE)
    assert again.contacts == {0: held[1], 1: held[2]}


def test_of_merged_contacts_the_longer_one_counts() -> None:
    long = replace(contact("Left toe", 100.0, 135.0, 1.0), at=(1.2, 0.0, 0.0))
    short = contact("Left toe", 137.0, 140.0, 1.0)
    assert found_again([LEFT], [long, short], METRE).contacts == {0: long}


def test_what_is_new_in_a_stance_that_was_moved_goes_along() -> None:
    assert movers([LEFT, RIGHT], {0: MOVED}) == {0: MOVED, 1: MOVED}
    assert movers([LEFT, RIGHT, LEFT], {0: MOVED, 1: RIGHT}) == {0: MOVED, 1: RIGHT}


def test_what_counts_as_a_change() -> None:
    assert not LEFT.changed
    for changed in (MOVED, replace(LEFT, used=False), replace(LEFT, end_frame=130.0)):
        assert changed.changed


def test_what_is_no_number_is_as_it_was_found() -> None:
    nowhere = replace(MOVED, at=(nan, 0.0, 0.0), start_frame=nan, end_frame=nan)
    assert HeldContact.of(nowhere) == LEFT


def test_frames_of_the_artist_stay_or_go_along() -> None:
    assert frame_of(101.0, 100.0, 100.0) == 101.0  # as found
    assert frame_of(101.0, 100.0, 97.0) == 97.0
    assert frame_of(120.0, 100.0, 97.0) == 117.0
