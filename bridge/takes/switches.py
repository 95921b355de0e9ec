"""Switches, thrown from one whole frame to the next, that stay so where durations change: no whole
frame shows one half thrown.

A curve is switched where one or two of the steps between keys on neighbouring whole frames change
it by most of what it ever changes, and those beside them not at all: a blink is thrown and thrown
back. More steps are a motion, and smaller ones a recording's last digits.
"""

from __future__ import annotations

import numpy as np

from ...solver.arrays import BoolArray, FloatArray
from .take_time import TakeTime

EPSILON = 1e-4  # frames
MOST_STEPS = 2
THROWN = 0.5  # share of a curve's range
_LEVEL = 1e-6  # share of the largest value, or of 1, by which values are still the same


def on_whole_frames(at: FloatArray, values: FloatArray, time: TakeTime) -> FloatArray:
    """Result frames (n,) of a take's keys, of values (n,) at frames (n,): those of a switch are on
    neighbouring whole frames there, too. Where durations shrink such that one has no room between
    the keys beside it, it is where the take's time has it."""
    found = time.to_result(at)
    for first, last in _runs(values, _changing(values) & _neighbours(at)):
        before = found[first - 1] if first else -np.inf
        after = found[last + 1] if last + 1 < len(at) else np.inf
        middle = (found[first] + found[last]) / 2.0
        begin = np.round(middle - (last - first) / 2.0)
        if at[first] <= time.recorded[0] or at[last] >= time.recorded[-1]:
            kept = first if at[first] <= time.recorded[0] else last
            begin = np.round(found[kept]) - (kept - first)  # no duration changes there
        else:
            begin = max(begin, np.floor(before + EPSILON) + 1.0)
        end = begin + last - first
        if before + EPSILON < begin and end + EPSILON < after:
            found[first : last + 1] = np.arange(begin, end + 1.0)
    return found


def switched(values: FloatArray) -> BoolArray:
    """(T - 1,) whether a curve of values (T,) on whole frames is switched between each two."""
    found = np.zeros(len(values) - 1, dtype=bool)
    for first, last in _runs(values, _changing(values)):
        found[first:last] = True
    return found


def _changing(values: FloatArray) -> BoolArray:
    same = _LEVEL * max(1.0, float(np.abs(values).max(initial=0.0)))
    return np.asarray(np.abs(np.diff(values)) > same)


def _neighbours(at: FloatArray) -> BoolArray:
    """(n - 1,) whether keys at frames (n,) and the next ones are on neighbouring whole frames."""
    whole = np.abs(at - np.round(at)) < EPSILON
    return np.asarray(whole[1:] & whole[:-1] & (np.abs(np.diff(at) - 1.0) < EPSILON))


def _runs(values: FloatArray, steps: BoolArray) -> list[tuple[int, int]]:
    """First and last key of each few steps (n - 1,) in a row by which a curve of values (n,) is
    switched."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], steps, [False]])))
    runs = zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True)
    least = THROWN * float(np.ptp(values)) if len(values) else 0.0
    return [
        (first, last)
        for first, last in runs
        if last - first <= MOST_STEPS and np.ptp(values[first : last + 1]) >= least
    ]
