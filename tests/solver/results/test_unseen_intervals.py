"""In which intervals something unseen carries, and in which it only turns."""

import numpy as np
from hangtime.solver.results.unseen_support import support_intervals

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
