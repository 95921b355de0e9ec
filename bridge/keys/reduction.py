"""Few keys for a whole figure, such that no error is beyond what it may be.

First all bones get the same key frames, whole-body columns as an animator sets them: spans that
leave too much are halved until none does. While bones share their frames, the errors along a chain
are those of one smooth motion and do not add up. Then each bone drops the keys that nothing carried
by it needs, under a limit that rises in steps to what is allowed, so that no bone uses up what the
others could share.
"""

from __future__ import annotations

from collections.abc import Generator, Iterator
from time import perf_counter

import numpy as np

from ...solver.arrays import BoolArray, FloatArray
from .figure import Errors, KeyableFigure
from .hermite import HermiteKeys, fitted, refitted

SHARES = (0.8, 1.0, 1.0)  # of what is allowed, pass after pass
HOPELESS = 2.0  # times the share: moving the neighbours of a dropped key does not make up for it
SLICE_S = 0.02
WINDOW = 2  # keys on each side of a dropped one that are fitted anew


def reduced(figure: KeyableFigure) -> Generator[None, None, list[HermiteKeys]]:
    """Keys by bone, in slices of some 20 ms each."""
    columns = shared_columns(figure)
    yield
    thinning = _Thinning(figure, columns)
    for share in SHARES:
        for bone in range(len(figure.bones)):
            yield from thinning.thin(bone, share)
    return thinning.keys


def shared_columns(figure: KeyableFigure) -> FloatArray:
    """Frames (K,) of keys with which the whole figure is near enough: halved where it is not."""
    frames = figure.frames
    fixed = {frame for bone in figure.bones for frame in bone.fixed}
    at = np.array(sorted({float(frames[0]), float(frames[-1]), *fixed}))
    while True:
        bad = figure.worst(errors_of(figure, keys_at(figure, [at] * len(figure.bones)))) > 1.0
        split = halved(at, frames, bad)
        if len(split) == len(at):
            return at
        at = split


def keys_at(figure: KeyableFigure, at: list[FloatArray]) -> list[HermiteKeys]:
    """Least-squares keys by bone at frames (K,) each."""
    return [
        fitted(bone.samples, figure.frames, own) for bone, own in zip(figure.bones, at, strict=True)
    ]


def errors_of(figure: KeyableFigure, keys: list[HermiteKeys]) -> Errors:
    """Errors of the whole figure at all frames."""
    total, always = figure.no_errors(), slice(None)
    for bone, (own, limb) in enumerate(zip(keys, figure.carried, strict=True)):
        errors = figure.errors_by(bone, own.at(figure.frames) - figure.bones[bone].samples)
        total.put(limb, always, total.of(limb, always) + errors)
    return total


def halved(at: FloatArray, frames: FloatArray, bad: BoolArray) -> FloatArray:
    """Key frames (K,) with one more in the middle of each span that has a bad frame (T,), or, where
    no frame is left in it, of the nearest span that has one."""
    first = np.searchsorted(frames, at)
    room = np.diff(first) > 1
    if not (bad.any() and room.any()):
        return at
    span = np.clip(np.searchsorted(first, np.flatnonzero(bad), side="right") - 1, 0, len(room) - 1)
    roomy = np.flatnonzero(room)
    nearest = roomy[np.abs(span[:, None] - roomy).argmin(axis=1)]
    middles = (first[nearest] + first[nearest + 1]) // 2
    return np.asarray(np.unique(np.concatenate([at, frames[middles]])))


class _Thinning:
    """Keys by bone, with the errors that they leave, while some are dropped."""

    def __init__(self, figure: KeyableFigure, columns: FloatArray) -> None:
        self.figure = figure
        self.keys = keys_at(figure, [columns] * len(figure.bones))
        self._errors = errors_of(figure, self.keys)
        # By bone and frame: the error without that key, over what it may be.
        self._needed: dict[tuple[int, float], float] = {}
        self._began = perf_counter()

    def thin(self, bone: int, share: float) -> Generator[None, None, None]:
        """Drop the keys of a bone without which no error is beyond a share of what it may be.

        Each second one in a row at most; the next pass may take those between.
        """
        fixed = self.figure.bones[bone].fixed
        at = 1
        while at < len(self.keys[bone].frames) - 1:
            if self.keys[bone].frames[at] not in fixed:
                self._drop(bone, at, share)
            at += 1
            if perf_counter() - self._began > SLICE_S:
                yield
                self._began = perf_counter()

    def _drop(self, bone: int, at: int, share: float) -> bool:
        """Drop a bone's key where errors allow it, moving its neighbours if need be."""
        figure, limb, frame = self.figure, self.figure.carried[bone], self.keys[bone].frames[at]
        if self._needed.get((bone, frame), 0.0) > HOPELESS * share:
            return False
        for frames in self._without(bone, at):
            keys, within = self._fitted_around(bone, at, frames)
            times = figure.frames[within]
            before = self._errors.of(limb, within)
            off = keys.at(times) - self.keys[bone].at(times)
            after = before + figure.errors_by(bone, off, within)
            left = figure.worst(after, within, limb.points)
            if (left <= np.maximum(share, figure.worst(before, within, limb.points))).all():
                self._errors.put(limb, within, after)
                self.keys[bone] = keys
                return True
            if left.max() > HOPELESS * share:
                # As keys are dropped errors grow: this holds until the limit has risen.
                self._needed[bone, frame] = float(left.max())
                return False
        return False

    def _without(self, bone: int, at: int) -> Iterator[FloatArray]:
        """Key frames of a bone without one: its neighbours where they are, then one of them nearer
        to the other, then both."""
        rest = np.delete(self.keys[bone].frames, at)
        yield rest
        free = [
            0 < i < len(rest) - 1 and rest[i] not in self.figure.bones[bone].fixed
            for i in (at - 1, at)
        ]
        step = np.round((rest[at] - rest[at - 1]) / 4.0)
        for left, right in ((step, 0.0), (0.0, step), (step, step)):
            if (left and not free[0]) or (right and not free[1]) or not (left or right):
                continue
            moved = rest.copy()
            moved[at - 1] += left
            moved[at] -= right
            if moved[at - 1] < moved[at]:
                yield moved

    def _fitted_around(self, bone: int, at: int, frames: FloatArray) -> tuple[HermiteKeys, slice]:
        """A bone's keys at frames without that of index `at`, fitted anew around it; and the slice
        of the figure's frames that this changes."""
        old = self.keys[bone]
        rest = HermiteKeys(frames, np.delete(old.values, at, 0), np.delete(old.slopes, at, 0))
        low, high = max(at - 1 - WINDOW, 0), min(at + WINDOW, len(frames) - 1)
        keys = refitted(rest, self.figure.bones[bone].samples, self.figure.frames, low, high)
        ends = frames[[max(low - 1, 0), min(high + 1, len(frames) - 1)]]
        first, last = np.searchsorted(self.figure.frames, ends)
        return keys, slice(int(first), int(last) + 1)
