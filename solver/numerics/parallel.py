"""Sharing array work among threads: numpy and CasADi let go of Python's lock while they compute."""

import itertools
import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import cache

import numpy as np

MOST = 4


def in_threads(work: Callable[[slice], object], count: int, fewest: int) -> None:
    """Calls work on slices that together cover range(count), at least `fewest` each."""
    workers = min(MOST, os.cpu_count() or 1, count // fewest)
    if workers < 2:
        work(slice(0, count))
        return
    edges = np.linspace(0, count, workers + 1).astype(int).tolist()
    first, *others = (slice(a, b) for a, b in itertools.pairwise(edges))
    pending = [_pool().submit(work, part) for part in others]
    work(first)
    for each in pending:
        each.result()


@cache
def _pool() -> ThreadPoolExecutor:
    """One for the process: starting threads for every call would take longer than some calls."""
    return ThreadPoolExecutor(MOST, thread_name_prefix="hangtime")
