"""Keys fitted to samples in windows of a few, many windows at once: values, slopes, handles, and
where the keys are.

Levenberg and Marquardt's method on the sum of squares. Channels share nothing but their frames; so
each is eliminated by itself, and what is left is a small system in the frames (Schur complement).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...solver.arrays import BoolArray, FloatArray
from .bezier import AFTER, BEFORE, EVEN, Curves, chosen, curves

NEAREST, FARTHEST = 0.1, 0.7  # shares of a gap that a handle may reach over
# Weight of a handle's difference from a third, in errors that are allowed: it decides what samples
# do not, as where nothing moves, and moves nothing else.
EVENNESS = 1e-3
FIRST_DAMPING, LEAST_DAMPING, MOST_DAMPING = 1e-4, 1e-9, 1.0
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
        fits, shown = self, self.shown
        left = fits._cost(shown)
        damping = np.full(len(self.at), FIRST_DAMPING)
        for _ in range(steps):
            tried = fits._stepped(shown, damping)
            seen = tried.shown
            cost = tried._cost(seen)
            better, gained = cost < left, left - cost > GAIN * left
            fits = replace(
                fits,
                at=chosen(better, tried.at, fits.at),
                parameters=chosen(better, tried.parameters, fits.parameters),
            )
            shown = seen.where(better, shown)
            left = np.where(better, cost, left)
            if not ((better & gained) | (~better & (damping < MOST_DAMPING))).any():
                break
            scale = np.where(better, 1.0 / DAMPING_STEP, DAMPING_STEP)
            damping = np.maximum(damping * scale, LEAST_DAMPING)
        return fits

    def _cost(self, shown: Curves) -> FloatArray:
        """(C,)."""
        uneven = self.parameters[..., [BEFORE, AFTER]] - EVEN
        errors = (shown.values - self.samples) * self.weights
        return np.asarray((errors**2).sum((1, 2)) + EVENNESS * (uneven**2).sum((1, 2, 3)))

    def _stepped(self, shown: Curves, damping: FloatArray) -> LocalFits:
        """One damped step on. damping: (C,)."""
        (groups, channels, keys), size = self.parameters.shape[:3], 4 * self.parameters.shape[2]
        is_handle = np.tile(np.isin(np.arange(4), [BEFORE, AFTER]), keys)
        products, slopes = self._normal(shown)
        was = self.parameters.reshape(groups, channels, size)
        slope = slopes[..., :size] + is_handle * EVENNESS * (was - EVEN)
        pushed = ((was <= NEAREST) & (slope > 0.0)) | ((was >= FARTHEST) & (slope < 0.0))
        free = self.free.reshape(groups, 1, size) & ~(is_handle & pushed)
        bend = products[..., :size, :size] * (free[..., None] & free[..., None, :])
        diagonal = np.einsum("cnii->cni", bend)
        grown = diagonal * (1.0 + damping[:, None, None]) + EVENNESS * is_handle + _TINY
        np.copyto(diagonal, np.where(free, grown, 1.0))
        cross = products[..., :size, size:] * free[..., None] * self.moves[:, None, None]
        solved = np.linalg.solve(bend, np.concatenate([(slope * free)[..., None], cross], axis=3))
        along = np.zeros((groups, keys))
        if self.moves.any():
            both = self.moves[:, :, None] & self.moves[:, None]
            inner = products[..., size:, size:].sum(axis=1) * both
            own = np.einsum("cii->ci", inner)
            np.copyto(own, np.where(self.moves, own * (1.0 + damping[:, None]) + _TINY, 1.0))
            less = (np.swapaxes(cross, 2, 3) @ solved).sum(axis=1)
            right = slopes[..., size:].sum(axis=1) * self.moves - less[..., 0]
            along = np.linalg.solve(inner - less[..., 1:], right[..., None])[..., 0]
            along = _apart(self.at, along)
        now = was - solved[..., 0] + (solved[..., 1:] @ along[:, None, :, None])[..., 0]
        now = np.where(is_handle & free, np.clip(now, NEAREST, FARTHEST), now)
        return replace(self, at=self.at - along, parameters=now.reshape(self.parameters.shape))

    def _normal(self, shown: Curves) -> tuple[FloatArray, FloatArray]:
        """Products (C, n, 5 M, 5 M) of the errors' Jacobian by parameters and by frames of keys,
        and (C, n, 5 M) with the errors."""
        groups, channels, keys = self.parameters.shape[:3]
        products = np.zeros((groups, channels, 5 * keys, 5 * keys))
        slopes = np.zeros((groups, channels, 5 * keys))
        jacobian = np.concatenate([shown.by_keys, shown.by_frames], axis=3)
        jacobian *= self.weights[..., None]
        errors = ((shown.values - self.samples) * self.weights)[..., None]
        for span in range(keys - 1):
            within = jacobian * (shown.spans == span)[:, None, :, None]
            turned = np.swapaxes(within, 2, 3)
            square, slope = turned @ jacobian, (turned @ errors)[..., 0]
            own, at = slice(4 * span, 4 * span + 8), slice(4 * keys + span, 4 * keys + span + 2)
            for to, part in ((own, slice(8)), (at, slice(8, 10))):
                slopes[..., to] += slope[..., part]
                for other, rest in ((own, slice(8)), (at, slice(8, 10))):
                    products[..., to, other] += square[..., part, rest]
        return products, slopes


def _apart(at: FloatArray, back: FloatArray) -> FloatArray:
    """By how much (C, M) keys go back, at most so far that they keep apart."""
    gaps = CLOSER * np.diff(at, axis=1)
    ahead, behind = (np.pad(gaps, ((0, 0), side)) for side in ((0, 1), (1, 0)))
    return np.asarray(np.clip(back, -ahead, behind))
