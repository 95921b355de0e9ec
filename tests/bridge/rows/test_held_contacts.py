"""Contacts found again by another analysis."""

from dataclasses import replace

import pytest
from hangtime.bridge.rows.held_contacts import HeldContact, found_again, frame_of, moves

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
    assert found_again(rows, held, METRE) == {0: MOVED, 1: RIGHT}


def test_of_another_take_those_near_by_at_the_same_time_are_the_same() -> None:
    rows = [contact("Right toe", 20.0, 60.0, 0.0), shifted(LEFT, 3.0, 0.1)]
    assert found_again(rows, [MOVED, RIGHT], METRE) == {1: MOVED}
    assert found_again(rows, [MOVED, RIGHT], 0.01) == {}  # 10 cm are ten units there


def test_what_is_new_in_a_stance_that_was_moved_goes_along() -> None:
    rows = [LEFT, RIGHT]
    assert moves(rows, {0: MOVED}) == {0: pytest.approx((0.2, 0.0, 0.0)), 1: MOVED.move}
    assert set(moves([*rows, LEFT], {0: MOVED, 1: RIGHT})) == {0, 1}


def test_what_counts_as_a_change() -> None:
    assert not LEFT.changed
    for changed in (MOVED, replace(LEFT, used=False), replace(LEFT, end_frame=130.0)):
        assert changed.changed


def test_frames_of_the_artist_stay_or_go_along() -> None:
    assert frame_of(101.0, 100.0, 100.0) == 101.0  # as found
    assert frame_of(101.0, 100.0, 97.0) == 97.0
    assert frame_of(120.0, 100.0, 97.0) == 117.0
