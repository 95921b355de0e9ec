"""Few keys for a whole figure, such that no error is beyond what it may be.

First all bones get the same key frames, whole-body columns as an animator sets them: spans that
leave too much are halved until none does. Then each bone drops the keys that nothing carried by it
needs. Around a key that is dropped the neighbours are fitted anew: their values, their slopes, the
reach of the handles and where they are. Of some keys in a row one at a time is dropped, of each
bone in turn, so that what an error may be is shared out evenly.
"""

from __future__ import annotations

from collections.abc import Generator, Iterator
from dataclasses import dataclass, replace
from itertools import groupby

import numpy as np

from ...solver.arrays import BoolArray, FloatArray
from .bezier import AFTER, BEFORE, EVEN, BezierKeys
from .figure import Errors, KeyableFigure
from .hermite import fitted
from .local_fits import LocalFits

# Keys in a window: the two beside a dropped one are fitted anew, and those beyond them stay.
WINDOW = 4
MOVING_STEPS, STANDING_STEPS = 8, 3  # of the fits at most, before and after keys are on frames
BATCH = 32  # windows that are fitted at once, some 20 ms


def reduced(figure: KeyableFigure) -> Generator[None, None, list[BezierKeys]]:
    """Keys by bone, in slices of some 20 ms each."""
    columns = shared_columns(figure)
    yield
    thinning = _Thinning(figure, columns)
    quiet = turn = 0
    while quiet < WINDOW:
        dropped = yield from thinning.thin(turn)
        quiet, turn = 0 if dropped else quiet + 1, turn + 1
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


def keys_at(figure: KeyableFigure, at: list[FloatArray]) -> list[BezierKeys]:
    """Least-squares keys by bone at frames (K,) each."""
    return [
        fitted(bone.samples, figure.frames, own) for bone, own in zip(figure.bones, at, strict=True)
    ]


def errors_of(figure: KeyableFigure, keys: list[BezierKeys]) -> Errors:
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


@dataclass(frozen=True)
class _Trial:
    """Keys of a bone around one that is dropped.

    key: its index. at: (WINDOW,) frames and parameters (n, WINDOW, 4) of the keys around it.
    inside: (WINDOW,), which of them there are. moves: (WINDOW,), which may go along time. within:
    the figure's frames that this changes. values: (T', n) there, as they should be, and are once
    the keys are fitted.
    """

    bone: int
    key: int
    at: FloatArray
    parameters: FloatArray
    inside: BoolArray
    moves: BoolArray
    within: slice
    values: FloatArray


class _Thinning:
    """Keys by bone, with the errors that they leave, while some are dropped."""

    def __init__(self, figure: KeyableFigure, columns: FloatArray) -> None:
        self.figure = figure
        self.keys = keys_at(figure, [columns] * len(figure.bones))
        self._values = [own.at(figure.frames) for own in self.keys]
        self._errors = errors_of(figure, self.keys)
        self._weights = [_sensitivities(figure, bone) for bone in range(len(figure.bones))]
        # By bone the frames of keys without which errors are too large, as keys around them are.
        self._needed: list[set[float]] = [set(bone.fixed) for bone in figure.bones]

    def thin(self, turn: int) -> Generator[None, None, bool]:
        """Drop keys without which no error is beyond what it may be, of those whose turn it is, one
        in each window of each bone; whether there were such."""
        trials = [
            self._without(bone, key)
            for bone, own in enumerate(self.keys)
            for key in range(1 + turn % WINDOW, len(own.frames) - 1, WINDOW)
            if own.frames[key] not in self._needed[bone]
        ]
        fits = yield from self._fitted(trials)
        dropped: list[list[_Trial]] = [[] for _ in self.keys]
        for count, trial in enumerate(fits):
            if self._take(trial):
                dropped[trial.bone].append(trial)
            else:
                self._needed[trial.bone].add(float(self.keys[trial.bone].frames[trial.key]))
            if count % BATCH == 0:
                yield
        for bone, found in enumerate(dropped):
            self._drop(bone, found)
        return any(dropped)

    def _without(self, bone: int, key: int) -> _Trial:
        """A bone's keys without one."""
        keys = self.keys[bone]
        index = key - WINDOW // 2 + np.arange(WINDOW)
        inside = (index >= 0) & (index < len(keys.frames) - 1)
        nearest = np.clip(index, 0, len(keys.frames) - 2)
        old = nearest + (nearest >= key)
        parameters = np.swapaxes(keys.parameters[old], 0, 1).copy()
        parameters[:, WINDOW // 2 - 1, AFTER] = EVEN
        parameters[:, WINDOW // 2, BEFORE] = EVEN
        at = keys.frames[old]
        stay = {float(at[0]), float(at[-1]), *self.figure.bones[bone].fixed}
        moves = inside & [frame not in stay for frame in at.tolist()]
        first, last = np.searchsorted(self.figure.frames, at[[0, -1]]).tolist()
        within = slice(first, last + 1)
        at = at + (index - nearest)  # beyond the ends: anywhere, but in order
        samples = self.figure.bones[bone].samples[within]
        return _Trial(bone, key, at, parameters, inside, moves, within, samples)

    def _fitted(self, trials: list[_Trial]) -> Generator[None, None, list[_Trial]]:
        """With keys fitted anew, many windows at once: those with as many channels, and of about
        the same length."""
        found = list(trials)
        size = [(trial.values.shape[1], len(trial.values)) for trial in trials]
        order = sorted(range(len(trials)), key=size.__getitem__)
        for _, alike in groupby(order, key=lambda i: size[i][0]):
            rest = list(alike)
            for first in range(0, len(rest), BATCH):
                batch = rest[first : first + BATCH]
                for i, fit in zip(batch, self._fits([trials[i] for i in batch]), strict=True):
                    found[i] = fit
                yield
        return found

    def _fits(self, trials: list[_Trial]) -> Iterator[_Trial]:
        """Of windows with as many channels."""
        frames = self.figure.frames
        at, parameters, inside, moves = (
            np.stack([getattr(trial, name) for trial in trials])
            for name in ("at", "parameters", "inside", "moves")
        )
        free = np.repeat(inside[:, :, None], 4, axis=2)
        free[:, 0, :AFTER] = free[:, -1, :BEFORE] = free[:, -1, AFTER:] = False
        ends = [(trial.within.start, trial.within.stop) for trial in trials]
        first, stop = np.array(ends).T[..., None]
        rows = first + np.arange((stop - first).max())
        counted, rows = rows < stop, np.minimum(rows, stop - 1)
        samples, weights = (
            np.stack([of[trial.bone][row].T for trial, row in zip(trials, rows, strict=True)])
            for of in ([bone.samples for bone in self.figure.bones], self._weights)
        )
        weights *= counted[:, None]
        fits = LocalFits(at, parameters, free, moves, frames[rows], samples, weights)
        fits = fits.held(handles=True).improved(1).freed(free, moves).improved(MOVING_STEPS)
        fits = fits.on(frames, at).held(handles=False).improved(STANDING_STEPS)
        for trial, own, found, values in zip(
            trials, fits.at, fits.parameters, fits.shown.values, strict=True
        ):
            shown = values.T[: len(trial.values)]
            yield replace(trial, at=own, parameters=found, values=shown)

    def _take(self, trial: _Trial) -> bool:
        """Let a trial's errors be those of the figure, where none is beyond what it may be, or is
        larger than it was."""
        figure, bone, within = self.figure, trial.bone, trial.within
        limb = figure.carried[bone]
        before = self._errors.of(limb, within)
        off = trial.values - self._values[bone][within]
        after = before + figure.errors_by(bone, off, within)
        was, left = (figure.worst(errors, within, limb.points) for errors in (before, after))
        if (left > np.maximum(1.0, was)).any():
            return False
        self._errors.put(limb, within, after)
        self._values[bone][within] = trial.values
        return True

    def _drop(self, bone: int, trials: list[_Trial]) -> None:
        """Let the keys of trials, which share outermost keys at most, be those of a bone."""
        frames, parameters = (
            a.copy() for a in (self.keys[bone].frames, self.keys[bone].parameters)
        )
        fixed = set(self.figure.bones[bone].fixed)
        for trial in trials:
            index = trial.key - WINDOW // 2 + np.arange(WINDOW)
            index += index >= trial.key
            around = frames[np.clip([index[0], index[-1]], 0, len(frames) - 1)]
            kept = {f for f in self._needed[bone] if f in fixed or not around[0] <= f <= around[1]}
            self._needed[bone] = kept
            inner = trial.inside.copy()
            inner[[0, -1]] = False
            frames[index[inner]] = trial.at[inner]
            parameters[index[inner]] = np.swapaxes(trial.parameters[:, inner], 0, 1)
            for end, handle in ((0, AFTER), (-1, BEFORE)):
                if trial.inside[end]:
                    parameters[index[end], :, handle] = trial.parameters[:, end, handle]
        gone = [trial.key for trial in trials]
        self.keys[bone] = BezierKeys(np.delete(frames, gone), np.delete(parameters, gone, axis=0))


def _sensitivities(figure: KeyableFigure, bone: int) -> FloatArray:
    """(T, n) the largest error, over what it may be, of anything carried by a bone, for each unit
    of its channels; 1 where a channel moves nothing."""
    samples, limb = figure.bones[bone].samples, figure.carried[bone]
    each = [
        figure.worst(
            figure.errors_by(bone, np.broadcast_to(unit, samples.shape)), slice(None), limb.points
        )
        for unit in np.eye(samples.shape[1])
    ]
    found = np.stack(each, axis=1)
    return np.where(found > 0.0, found, 1.0)
