"""A body that is carried unseen for a part of the time in which nothing touches, and falls freely
for another, flies there."""

import numpy as np
import pytest
from hangtime.solver.analysis.analyse import analyse
from hangtime.solver.arrays import FloatArray
from hangtime.solver.data.constants import STANDARD_GRAVITY
from hangtime.solver.data.contacts import Interval
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.unseen.free_fall import falls_within, without_falls
from hangtime.tests.helpers.clips import load_recording
from hangtime.tests.helpers.hung import LANDING, RELEASE, hung

END = 2.0  # s
NEAR = 0.05  # s; as an acceleration is told over twice that


def swung_off(times: FloatArray, release: float, gravity: float = STANDARD_GRAVITY) -> FloatArray:
    """(T, 3) m, of a body that swings at 2 m/s, lets go, and falls."""
    angle = 2.0 * np.minimum(times, release) / 0.5
    fall = np.maximum(times - release, 0.0)
    level = 2.0 * np.array([np.cos(angle[-1]), -np.sin(angle[-1])])
    path = 0.5 * np.stack([np.sin(angle), np.cos(angle)], axis=1) + np.outer(fall, level)
    return np.column_stack([path, 2.0 - 0.5 * gravity * fall**2])


@pytest.mark.parametrize("rate", [24.0, 30.0, 60.0, 120.0, 240.0])
def test_who_lets_go_falls_from_then_on(rate: float) -> None:
    times = np.arange(0.0, END + 0.5 / rate, 1.0 / rate)
    noise = np.random.default_rng(3).normal(scale=0.0003, size=(len(times), 3))
    com = swung_off(times, release=1.5) + noise
    whole = Interval(0.0, END)
    (fall,) = falls_within(times, com, [whole])
    assert fall.start == pytest.approx(1.5, abs=NEAR + 1.0 / rate)
    (carried,) = without_falls(whole, [fall])
    assert (carried.start, carried.end) == (0.0, fall.start)


def test_who_is_let_down_slowly_or_swings_on_does_not_fall() -> None:
    times = np.linspace(0.0, END, 121)
    for com in (swung_off(times, release=1.5, gravity=6.0), swung_off(times, release=END)):
        assert falls_within(times, com, [Interval(0.0, END)]) == ()


def test_who_bobs_on_a_floor_that_is_not_found_does_not_fall() -> None:
    """Without weight at the crest, and nearly so for a moment before and after it."""
    times = np.linspace(0.0, END, 241)
    for beats in (2.0, 2.5, 3.0):  # a second
        pace = 2.0 * np.pi * beats
        high = STANDARD_GRAVITY / pace**2 * np.cos(pace * times)
        com = np.stack([np.zeros_like(times), np.zeros_like(times), 1.0 + high], axis=1)
        assert falls_within(times, com, [Interval(0.0, END)]) == ()


def test_too_few_frames_tell_no_fall() -> None:
    times = np.linspace(0.0, 0.1, 4)
    com = np.outer(-0.5 * STANDARD_GRAVITY * times**2, [0.0, 0.0, 1.0])
    assert falls_within(times, com, [Interval(0.0, 0.1)]) == ()


def test_a_flight_after_a_swing_can_be_named() -> None:
    schedule = analyse(hung(high_hands=False), MotionProblem()).schedule
    assert [phase.name for phase in schedule.phases] == ["ground 1", "flight 1", "ground 2"]
    (flight,), (unseen,) = schedule.flights, schedule.unseen
    assert (flight.start, flight.end) == pytest.approx((RELEASE, LANDING), abs=NEAR)
    assert (unseen.start, unseen.end) == (0.0, flight.start)


def test_a_dance_whose_floor_drifts_has_no_flight() -> None:
    assert analyse(load_recording("rokoko_jesse_dance.bvh"), MotionProblem()).schedule.flights == ()


def test_what_is_left_of_a_gap_ends_where_the_gap_does() -> None:
    gap = Interval(0.1, 0.1 + 0.7)
    assert without_falls(gap, []) == (gap,)
    (left,) = without_falls(gap, [Interval(0.0, 0.35)])
    assert left.end == gap.end
