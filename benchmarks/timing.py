"""Fair timing: what is quick takes turns a few times, and the median counts."""

import time
import tracemalloc
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


def processor(work: Callable[[], Result]) -> tuple[Result, float]:
    """What `work` gives, and the processor's seconds, of all threads, that it took."""
    begun = time.process_time()
    return work(), time.process_time() - begun


def memory(work: Callable[[], object]) -> float:
    """The most that `work` holds at once beyond what was held before, MB."""
    tracemalloc.start()
    try:
        work()
        return tracemalloc.get_traced_memory()[1] / 1e6
    finally:
        tracemalloc.stop()


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
