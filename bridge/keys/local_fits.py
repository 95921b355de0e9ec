"""Keys fitted to samples in windows of a few, many windows at once: values, slopes, handles, and
where the keys are.

Levenberg and Marquardt's method on the sum of squares. Channels share nothing but their frames; so
each is eliminated by itself, and what is left is a small system in the frames (Schur complement).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ...solver.arrays import BoolArray, FloatArray, IntArray
from .bezier import AFTER, BEFORE, EVEN, Curves, curves

NEAREST, FARTHEST = 0.1, 0.7  # shares of a gap that a handle may reach over
# Weight of a handle's difference from a third, in errors that are allowed: it decides what samples
# do not, as where nothing moves, and moves nothing else.
EVENNESS = 1e-3
FIRST_DAMPING, LEAST_DAMPING, MOST_DAMPING = 0.03, 1e-9, 1.0
DAMPING_STEP = 8.0
GAIN = 0.02  # share of the sum below which a step was the last
CLOSER = 0.4  # share of a gap by which a key may come nearer in one step
_TINY = 1e-13


@dataclass(frozen=True)
class LocalFits:
    """C windows of M keys of n channels, and their samples at T frames.

    at: (C, M) key frames, those at the ends fixed. parameters: (C, n, M, 4). free: (C, M, 4), which
    of them may change. moves: (C, M), which keys may go along time. frames: (C, T). samples,
    weights: (C, n, T); weights are over errors that are allowed, 0 where a window has ended.
    """

    at: FloatArray
    parameters: FloatArray
    free: BoolArray
    moves: BoolArray
    frames: FloatArray
    samples: FloatArray
    weights: FloatArray

    @property
    def shown(self) -> Curves:
        """The curves at the frames."""
        return curves(self.at, self.parameters, self.frames)

    def held(self, *, handles: bool) -> LocalFits:
        """With keys that stay at their frames, and handles as well where asked."""
        free = self.free.copy()
        if handles:
            free[:, :, [BEFORE, AFTER]] = False
        return replace(self, free=free, moves=np.zeros_like(self.moves))

    def freed(self, free: BoolArray, moves: BoolArray) -> LocalFits:
        """With other parameters, (C, M, 4), and keys, (C, M), that may change."""
        return replace(self, free=free, moves=moves)

    def on(self, frames: FloatArray, otherwise: FloatArray) -> LocalFits:
        """With keys that moved on the nearest of frames (F,); at other ones, (C, M), where two
        would be on the same."""
        after = np.clip(np.searchsorted(frames, self.at), 1, len(frames) - 1)
        nearer = after - (self.at - frames[after - 1] < frames[after] - self.at)
        at = np.where(self.moves, frames[nearer], self.at)
        apart = (np.diff(at, axis=1) > 0.0).all(axis=1)
        return replace(self, at=np.where(apart[:, None], at, otherwise))

    def improved(self, steps: int) -> LocalFits:
        """After some steps of the method, or until none helps."""
        fits, unknowns, shown = self, self._unknowns, self.shown
        left, normal = fits._cost(shown), fits._normal(shown, unknowns)
        damping = np.full(len(self.at), FIRST_DAMPING)
        for _ in range(steps):
            tried = fits._stepped(normal, unknowns, damping)
            shown = tried.shown
            cost = tried._cost(shown)
            better, gained = cost < left, left - cost > GAIN * left
            fits = replace(
                fits,
                at=_chosen(better, tried.at, fits.at),
                parameters=_chosen(better, tried.parameters, fits.parameters),
            )
            left = np.where(better, cost, left)
            if not ((better & gained) | (~better & (damping < MOST_DAMPING))).any():
                break
            now = tried._normal(shown, unknowns)
            normal = _Normal(*(_chosen(better, *each) for each in zip(now, normal, strict=True)))
            scale = np.where(better, 1.0 / DAMPING_STEP, DAMPING_STEP)
            damping = np.maximum(damping * scale, LEAST_DAMPING)
        return fits

    @property
    def _unknowns(self) -> _Unknowns:
        free = self.free.reshape(len(self.free), -1)
        columns = np.flatnonzero(free.any(axis=0))
        is_handle = np.isin(columns % 4, [BEFORE, AFTER])
        return _Unknowns(columns, np.flatnonzero(self.moves.any(axis=0)), is_handle)

    def _cost(self, shown: Curves) -> FloatArray:
        """(C,)."""
        uneven = self.parameters[..., [BEFORE, AFTER]] - EVEN
        errors = (shown.values - self.samples) * self.weights
        return np.asarray((errors**2).sum((1, 2)) + EVENNESS * (uneven**2).sum((1, 2, 3)))

    def _stepped(self, normal: _Normal, unknowns: _Unknowns, damping: FloatArray) -> LocalFits:
        """One damped step on. damping: (C,)."""
        columns, keys, is_handle = unknowns
        size = len(columns)
        every = self.parameters.reshape(*self.parameters.shape[:2], -1)
        was, moves = every[..., columns], self.moves[:, keys]
        slope = normal.slopes[..., :size] + is_handle * EVENNESS * (was - EVEN)
        pushed = ((was <= NEAREST) & (slope > 0.0)) | ((was >= FARTHEST) & (slope < 0.0))
        free = self.free.reshape(len(was), 1, -1)[..., columns] & ~(is_handle & pushed)
        bend = normal.products[..., :size, :size] * (free[..., None] & free[..., None, :])
        diagonal = np.einsum("cnii->cni", bend)
        grown = diagonal * (1.0 + damping[:, None, None]) + EVENNESS * is_handle + _TINY
        np.copyto(diagonal, np.where(free, grown, 1.0))
        cross = normal.products[..., :size, size:] * free[..., None] * moves[:, None, None]
        solved = np.linalg.solve(bend, np.concatenate([(slope * free)[..., None], cross], axis=3))
        less = (np.swapaxes(cross, 2, 3) @ solved).sum(axis=1)
        inner = normal.products[..., size:, size:].sum(axis=1)
        inner *= moves[:, :, None] & moves[:, None]
        own = np.einsum("cii->ci", inner)
        np.copyto(own, np.where(moves, own * (1.0 + damping[:, None]) + _TINY, 1.0))
        right = normal.slopes[..., size:].sum(axis=1) * moves - less[..., 0]
        along = np.zeros_like(self.at)
        along[:, keys] = np.linalg.solve(inner - less[..., 1:], right[..., None])[..., 0]
        along = _apart(self.at, along)
        now = was - solved[..., 0] + (solved[..., 1:] @ along[:, None, keys, None])[..., 0]
        now = np.where(is_handle & free, np.clip(now, NEAREST, FARTHEST), now)
        parameters = every.copy()
        parameters[..., columns] = now
        return replace(
            self, at=self.at - along, parameters=parameters.reshape(self.parameters.shape)
        )

    def _normal(self, shown: Curves, unknowns: _Unknowns) -> _Normal:
        """The normal equations of the unknowns."""
        within = [(shown.spans == span)[:, None] for span in range(self.at.shape[1] - 1)]

        def effect(key: int, before: FloatArray | None, after: FloatArray | None) -> FloatArray:
            """Of what changes the spans before and after a key."""
            found = np.zeros(shown.u.shape)
            if before is not None and key > 0:
                found += within[key - 1] * before
            if after is not None and key < len(within):
                found += within[key] * after
            return found

        by_keys, by_frames = shown.derivatives()
        rows = []
        for key, part in zip(*divmod(unknowns.columns, 4), strict=True):
            before = by_keys[4 + part] if part != AFTER else None
            rows.append(effect(key, before, by_keys[part] if part != BEFORE else None))
        rows += [effect(key, by_frames[1], by_frames[0]) for key in unknowns.keys]
        jacobian = np.stack(rows, axis=2) * self.weights[:, :, None]
        errors = ((shown.values - self.samples) * self.weights)[..., None]
        return _Normal(jacobian @ np.swapaxes(jacobian, 2, 3), (jacobian @ errors)[..., 0])


class _Unknowns(NamedTuple):
    """What any window may change. columns: (P,) parameters, counted over the keys. keys: (Q,) those
    that may go along time. is_handle: (P,)."""

    columns: IntArray
    keys: IntArray
    is_handle: BoolArray


class _Normal(NamedTuple):
    """Products (C, n, P + Q, P + Q) of the errors' Jacobian by the unknowns, and with the errors,
    slopes (C, n, P + Q)."""

    products: FloatArray
    slopes: FloatArray


def _chosen(rows: BoolArray, one: FloatArray, other: FloatArray) -> FloatArray:
    """One's rows where (C,) is true, else the other's."""
    return np.asarray(np.where(rows.reshape(-1, *(1,) * (one.ndim - 1)), one, other))


def _apart(at: FloatArray, back: FloatArray) -> FloatArray:
    """By how much (C, M) keys go back, at most so far that they keep apart."""
    gaps = CLOSER * np.diff(at, axis=1)
    ahead, behind = (np.pad(gaps, ((0, 0), side)) for side in ((0, 1), (1, 0)))
    return np.asarray(np.clip(back, -ahead, behind))
