"""Data-parallel array work in threads: numpy and CasADi release Python's lock as they compute."""

import itertools
import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import cache

import numpy as np

MAX_THREADS = 4


def in_threads(work: Callable[[slice], object], count: int, chunk: int) -> None:
    """Calls `work` on slices that partition range(count), at least `chunk` items each."""
    workers = min(MAX_THREADS, os.cpu_count() or 1, count // chunk)
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
    """One thread pool for the process: starting threads takes longer than some calls."""
    return ThreadPoolExecutor(MAX_THREADS, thread_name_prefix="hangtime")
