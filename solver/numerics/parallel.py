"""Data-parallel array work in threads: numpy and CasADi release Python's lock as they compute."""

import itertools
import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import cache

import numpy as np

from ..one_thread import SOLVER_THREADS

MAX_THREADS = 4


def in_threads(work: Callable[[slice], object], count: int, chunk: int) -> None:
    """Calls `work` on slices that partition range(count), at least `chunk` items each."""
    workers = min(_most_threads(), count // chunk)
    if workers < 2:
        work(slice(0, count))
        return
    edges = np.linspace(0, count, workers + 1).astype(int).tolist()
    first, *others = (slice(a, b) for a, b in itertools.pairwise(edges))
    pending = [_pool().submit(work, part) for part in others]
    work(first)
    for each in pending:
        each.result()


def _most_threads() -> int:
    """As many as the process may have cores, or is told to take."""
    told = os.environ.get(SOLVER_THREADS, "")
    return min(MAX_THREADS, int(told) if told.isdecimal() else cores())


def cores() -> int:
    """Cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


@cache
def _pool() -> ThreadPoolExecutor:
    """One thread pool for the process: starting threads takes longer than some calls."""
    return ThreadPoolExecutor(MAX_THREADS, thread_name_prefix="hangtime")
