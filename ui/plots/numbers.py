"""Printing of values, and decimation of curves that keeps their extremes."""

from itertools import pairwise
from math import floor, log10

import numpy as np

from ...solver.arrays import FloatArray


def decimals(step: float) -> int:
    """Digits behind the point that tell ticks of a step apart."""
    return max(0, -floor(log10(step) + 1e-9))


def number(value: float, digits: int) -> str:
    """In digits, with a true minus, and without the minus of what rounds to zero."""
    words = f"{value:.{digits}f}"
    return words.lstrip("-") if float(words) == 0.0 else words.replace("-", "\N{MINUS SIGN}")


def thinned(frames: FloatArray, values: FloatArray, columns: int) -> tuple[FloatArray, FloatArray]:
    """A curve of (T,) samples with no more than `columns` lowest and highest each.

    A curve's peaks are what is looked for; leaving out samples evenly would lose them.
    """
    if len(frames) <= 2 * columns:
        return frames, values
    edges = np.linspace(0, len(frames), columns + 1).astype(int)
    kept = {0, len(frames) - 1}
    for first, last in pairwise(edges):
        part = values[first:last]
        kept |= {first + int(part.argmin()), first + int(part.argmax())}
    index = sorted(kept)
    return frames[index], values[index]
