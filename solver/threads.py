"""Sharing array work among threads: numpy and CasADi let go of Python's lock while they compute."""

import itertools
import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np

MOST = 4


def in_threads(work: Callable[[slice], object], count: int, fewest: int) -> None:
    """Calls work on slices that together cover range(count), at least `fewest` each."""
    workers = min(MOST, os.cpu_count() or 1, count // fewest)
    if workers < 2:
        work(slice(0, count))
        return
    edges = np.linspace(0, count, workers + 1).astype(int).tolist()
    parts = [slice(a, b) for a, b in itertools.pairwise(edges)]
    with ThreadPoolExecutor(workers) as pool:
        list(pool.map(work, parts))
