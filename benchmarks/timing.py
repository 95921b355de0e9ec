"""Fair timing: what is quick takes turns a few times, and the median counts."""

import time
from collections.abc import Callable, Mapping
from statistics import median
from typing import TypeVar

Result = TypeVar("Result")
REPEATS = 5
LONG = 10.0  # s; what takes longer runs once


def timed(work: Callable[[], Result]) -> tuple[Result, float]:
    """What `work` gives, and the seconds that it took."""
    begun = time.perf_counter()
    return work(), time.perf_counter() - begun


def in_turns(
    works: Mapping[str, Callable[[], Result]], repeats: int = REPEATS
) -> dict[str, tuple[Result, float]]:
    """Each work's result and its median seconds, over interleaved repeats."""
    results: dict[str, Result] = {}
    seconds: dict[str, list[float]] = {name: [] for name in works}
    for _ in range(repeats):
        for name, work in works.items():
            if sum(seconds[name]) > LONG:
                continue
            results[name], taken = timed(work)
            seconds[name].append(taken)
    return {name: (results[name], median(seconds[name])) for name in works}
