"""In which intervals something unseen carries, and in which it only turns."""

from dataclasses import replace

import numpy as np
from hangtime.solver.results.unseen_support import support_intervals, weight_beside
from hangtime.tests.helpers.fitted_hop import fitted_hop

TIMES = np.linspace(0.0, 1.0, 501)


def between(*spans: tuple[float, float]) -> np.ndarray:
    return np.any([(first <= TIMES) & (last >= TIMES) for first, last in spans], axis=0)


def told(carries: np.ndarray, acts: np.ndarray) -> list[tuple[float, float]]:
    return [
        (round(float(TIMES[a]), 2), round(float(TIMES[b]), 2))
        for a, b in support_intervals(TIMES, carries, acts)
    ]


def test_what_turns_on_both_sides_of_what_carries_is_apart_from_it() -> None:
    """However short that is: it was told as one that carries all the while, and once more."""
    carries = between((0.5, 0.55))
    assert told(carries, between((0.0, 1.0))) == [(0.0, 0.5), (0.5, 0.55), (0.55, 1.0)]


def test_what_is_near_is_one_and_short_ends_are_none() -> None:
    carries = between((0.2, 0.3), (0.35, 0.6))
    assert told(carries, between((0.15, 0.65))) == [(0.2, 0.6)]


def test_nothing_is_told_where_nothing_acts() -> None:
    assert told(between((2.0, 3.0)), between((2.0, 3.0))) == []


def test_the_weight_is_over_what_carries_it_and_beside_what_is_left_of_that() -> None:
    """Of a hop without anything unseen, and as if its right foot were not known to touch."""
    motion = fitted_hop().motion
    times = np.linspace(0.0, motion.duration, 200)
    assert weight_beside(motion, times).max() < 0.01
    t = motion.transcription
    left = tuple(each for each in t.contacts if each.contact.bone.startswith("Left"))
    assert 0 < len(left) < len(t.contacts)
    beside = weight_beside(replace(motion, transcription=replace(t, contacts=left)), times)
    assert 0.03 < beside.max() < 0.4
