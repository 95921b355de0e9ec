"""Few keys for a whole figure, such that no error is beyond what it may be.

First all bones get the same key frames, whole-body columns as an animator sets them: spans that
leave too much are halved until none does. Then each bone drops the keys that nothing carried by it
needs. Around a key that is dropped the neighbours are fitted anew: their values, their slopes, the
reach of the handles and where they are. Of some keys in a row one at a time is dropped, of each
bone in turn, so that what an error may be is shared out evenly.
"""

from __future__ import annotations

from collections.abc import Generator, Iterator
from dataclasses import dataclass

import numpy as np

from ...solver.arrays import BoolArray, FloatArray, IntArray
from .bezier import AFTER, BEFORE, EVEN, BezierKeys
from .figure import Errors, KeyableFigure
from .hermite import fitted
from .local_fits import LocalFits

# Keys in a window: the two beside a dropped one are fitted anew, and those beyond them stay.
WINDOW = 4
MOVING_STEPS, STANDING_STEPS = 10, 6  # of the fits at most, before and after keys are on frames
BATCH = 8  # windows that are fitted at once, some 20 ms


def reduced(figure: KeyableFigure) -> Generator[None, None, list[BezierKeys]]:
    """Keys by bone, in slices of some 20 ms each."""
    columns = shared_columns(figure)
    yield
    thinning = _Thinning(figure, columns)
    quiet = turn = 0
    while quiet < WINDOW:
        dropped = False
        for bone in range(len(figure.bones)):
            dropped |= yield from thinning.thin(bone, turn)
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
    """Keys around one that is dropped, fitted anew.

    key: its index. at: (WINDOW,) frames and parameters (WINDOW, n, 4) of the keys around it.
    inside: (WINDOW,), which of them there are. within: the figure's frames that this changes.
    values: (T', n) there.
    """

    key: int
    at: FloatArray
    parameters: FloatArray
    inside: BoolArray
    within: slice
    values: FloatArray


class _Thinning:
    """Keys by bone, with the errors that they leave, while some are dropped."""

    def __init__(self, figure: KeyableFigure, columns: FloatArray) -> None:
        self.figure = figure
        self.keys = keys_at(figure, [columns] * len(figure.bones))
        self._values = [own.at(figure.frames) for own in self.keys]
        self._errors = errors_of(figure, self.keys)
        self._weights: dict[int, FloatArray] = {}  # by bone, when it is first asked for
        # By bone the frames of keys without which errors are too large, as keys around them are.
        self._needed: list[set[float]] = [set(bone.fixed) for bone in figure.bones]

    def thin(self, bone: int, turn: int) -> Generator[None, None, bool]:
        """Drop keys of a bone without which no error is beyond what it may be, of those whose turn
        it is, one in each window; whether there were such."""
        frames, needed = self.keys[bone].frames, self._needed[bone]
        turns = range(1 + turn % WINDOW, len(frames) - 1, WINDOW)
        wanted = np.array([k for k in turns if frames[k] not in needed], dtype=int)
        dropped: list[_Trial] = []
        for first in range(0, len(wanted), BATCH):
            for trial in self._trials(bone, wanted[first : first + BATCH]):
                if self._take(bone, trial):
                    dropped.append(trial)
                else:
                    needed.add(float(frames[trial.key]))
            yield
        self._drop(bone, dropped)
        return bool(dropped)

    def _trials(self, bone: int, dropped: IntArray) -> Iterator[_Trial]:
        """A bone's keys without one, fitted anew around it, for each of some (C,)."""
        frames, keys = self.figure.frames, self.keys[bone]
        if bone not in self._weights:
            self._weights[bone] = _sensitivities(self.figure, bone)
        index = dropped[:, None] - WINDOW // 2 + np.arange(WINDOW)
        inside = (index >= 0) & (index < len(keys.frames) - 1)
        nearest = np.clip(index, 0, len(keys.frames) - 2)
        old = nearest + (nearest >= dropped[:, None])
        at = keys.frames[old] + (index - nearest)  # beyond the ends: anywhere, but in order
        parameters = np.swapaxes(keys.parameters[old], 1, 2).copy()
        parameters[:, :, WINDOW // 2 - 1, AFTER] = EVEN
        parameters[:, :, WINDOW // 2, BEFORE] = EVEN
        free = np.repeat(inside[:, :, None], 4, axis=2)
        free[:, 0, :AFTER] = free[:, -1, :BEFORE] = free[:, -1, AFTER:] = False
        stays = np.isin(at, [*keys.frames[[0, -1]], *self.figure.bones[bone].fixed])
        moves = inside & ~stays
        moves[:, [0, -1]] = False
        first, last = (np.searchsorted(frames, keys.frames[old[:, end]]) for end in (0, -1))
        span = np.arange((last - first).max() + 1)
        rows = np.minimum(first[:, None] + span, last[:, None])
        counted = (first[:, None] + span <= last[:, None])[:, None]
        samples, weights = (
            np.swapaxes(each[rows], 1, 2)
            for each in (self.figure.bones[bone].samples, self._weights[bone])
        )
        fits = LocalFits(at, parameters, free, moves, frames[rows], samples, weights * counted)
        fits = fits.held(handles=True).improved(1).freed(free, moves).improved(MOVING_STEPS)
        fits = fits.on(frames, at).held(handles=False).improved(STANDING_STEPS)
        for c, values in enumerate(fits.shown.values):
            within = slice(int(first[c]), int(last[c]) + 1)
            yield _Trial(
                int(dropped[c]),
                fits.at[c],
                np.swapaxes(fits.parameters[c], 0, 1),
                inside[c],
                within,
                values.T[: within.stop - within.start],
            )

    def _take(self, bone: int, trial: _Trial) -> bool:
        """Let a trial's errors be those of the figure, where none is beyond what it may be, or is
        larger than it was."""
        figure, limb, within = self.figure, self.figure.carried[bone], trial.within
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
            parameters[index[inner]] = trial.parameters[inner]
            for end, handle in ((0, AFTER), (-1, BEFORE)):
                if trial.inside[end]:
                    parameters[index[end], :, handle] = trial.parameters[end, :, handle]
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
