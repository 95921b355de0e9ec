"""Where the keys of a switch are in a result of other durations."""

from __future__ import annotations

import numpy as np
import pytest
from hangtime.bridge.takes.switches import on_whole_frames, switched
from hangtime.bridge.takes.take_time import TakeTime

LONGER = TakeTime(np.array([0.0, 10.0, 20.0]), np.array([0.0, 10.0, 25.0]))
SHORTER = TakeTime(np.array([0.0, 12.0]), np.array([0.0, 4.0]))


@pytest.mark.parametrize(
    ("at", "values", "thrown"),
    [
        ([0, 10, 14, 15, 20, 30], [0, 0, 0, 1, 1, 1], [16, 17]),
        ([0, 10, 14, 15, 16, 20, 30], [0, 0, 0, 1, 0, 0, 0], [16, 17, 18]),  # a blink
    ],
)
def test_a_switch_is_on_neighbouring_whole_frames(
    at: list[float], values: list[float], thrown: list[float]
) -> None:
    found = on_whole_frames(np.array(at, float), np.array(values, float), LONGER)
    np.testing.assert_array_equal(found[2 : 2 + len(thrown)], thrown)


def test_a_motion_goes_by_the_take_s_time() -> None:
    at, values = np.arange(11.0, 18.0), np.array([0.0, 0.0, 1.0, 2.0, 3.0, 3.0, 3.0])
    np.testing.assert_array_equal(on_whole_frames(at, values, LONGER), LONGER.to_result(at))


@pytest.mark.parametrize(
    ("at", "values"),
    [
        ([0, 6, 7, 7.5, 20], [0, 0, 1, 0.5, 0.5]),  # before the next key
        ([0, 9, 10, 11, 12, 20], [0, 0, 0, 0, 1, 1]),  # after one, at the end of what is retimed
        ([0, 10.5, 11, 12, 20], [0, 0.7, 0, 1, 1]),
    ],
)
def test_a_switch_without_room_keeps_the_order_of_keys(
    at: list[float], values: list[float]
) -> None:
    found = on_whole_frames(np.array(at, float), np.array(values, float), SHORTER)
    np.testing.assert_array_equal(found, SHORTER.to_result(np.array(at, float)))
    assert (np.diff(found) > 0.0).all()


def test_values_are_switched_in_one_or_two_steps() -> None:
    values = np.array([0.0, 0.0, 1.0, 1.0, 0.0, 1.0, 1.0, 0.7, 0.3, 0.0, 0.0])
    assert np.flatnonzero(switched(values)).tolist() == [1, 3, 4]


def test_the_last_digits_of_a_slow_motion_are_no_switch() -> None:
    """As of recordings in files, which hold few decimals."""
    values = np.round(0.01 * np.sin(np.linspace(0.0, 1.5, 60)), 3)
    assert not switched(values).any()
