"""Runs of frames of which something is true."""

import numpy as np

from ..arrays import BoolArray


def runs(mask: BoolArray) -> list[tuple[int, int]]:
    """First and last index of every run of True in (T,)."""
    edges = np.diff(np.concatenate(([0], mask.astype(np.int8), [0])))
    first, last = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1) - 1
    return list(zip(first.tolist(), last.tolist(), strict=True))
