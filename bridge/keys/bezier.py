"""Bézier curves as F-curves have them, and how they change with their keys.

A handle's reach is a share of the gap to the next key. At a third on both sides time runs evenly
along the curve, which then is a cubic Hermite spline (`hermite.py`); other shares let one span turn
faster at one end, so that fewer keys are as near to a motion.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...solver.arrays import FloatArray, IntArray

EVEN = 1.0 / 3.0  # share of the gap at which time runs evenly
VALUE, SLOPE, BEFORE, AFTER = range(4)  # parameters of a key of a channel
NEWTON_STEPS = 5  # to rounding, with handles that reach over less than 0.75 of the gap


@dataclass(frozen=True)
class BezierKeys:
    """Keys of n channels that share their frames (K,), ascending.

    parameters: (K, n, 4); value, slope (a frame, the same on both sides), and the reach of the
    handles before and after, as shares of the gaps.
    """

    frames: FloatArray
    parameters: FloatArray

    @classmethod
    def even(cls, frames: FloatArray, values: FloatArray, slopes: FloatArray) -> BezierKeys:
        """Keys with values and slopes (K, n), between which time runs evenly."""
        reach = np.full(values.shape, EVEN)
        return cls(frames, np.stack([values, slopes, reach, reach], axis=2))

    @property
    def values(self) -> FloatArray:
        """(K, n)."""
        return self.parameters[..., VALUE]

    @property
    def slopes(self) -> FloatArray:
        """(K, n), a frame."""
        return self.parameters[..., SLOPE]

    def part(self, channels: slice) -> BezierKeys:
        """The keys of some of the channels."""
        return BezierKeys(self.frames, self.parameters[:, channels])

    def at(self, frames: FloatArray) -> FloatArray:
        """Values (T, n) at frames (T,), constant outside."""
        frames = np.clip(frames, self.frames[0], self.frames[-1])
        parameters = np.swapaxes(self.parameters, 0, 1)[None]
        return np.asarray(curves(self.frames[None], parameters, frames[None]).values[0].T)


@dataclass(frozen=True)
class Curves:
    """C groups of n curves at T frames each, and their derivatives.

    spans: (C, T), the key before each frame. x: (C, 1, T) share of the gap there; gap: (C, 1, T)
    frames. before, after: value, rise and reach of the handle, (3, C, n, T), of the key before and
    after; a rise is the slope times the gap. u: (C, n, T) where along the curve.
    """

    spans: IntArray
    x: FloatArray
    gap: FloatArray
    before: FloatArray
    after: FloatArray
    u: FloatArray

    @cached_property
    def _handles(self) -> tuple[FloatArray, FloatArray]:
        """Bernstein's polynomials of both (C, n, T)."""
        u, w = self.u, 1.0 - self.u
        both = 3.0 * u * w
        return both * w, both * u

    @cached_property
    def _reach(self) -> FloatArray:
        """(C, n, T) what slopes add to the values."""
        (_, rise, a), (_, fall, b), (first, second) = self.before, self.after, self._handles
        return np.asarray(first * a * rise - second * b * fall)

    @cached_property
    def _start(self) -> FloatArray:
        """(C, n, T) share of the value before; the rest is that of the one after."""
        w = 1.0 - self.u
        return np.asarray(w * w * w + self._handles[0])

    @property
    def values(self) -> FloatArray:
        """(C, n, T)."""
        value, later = self.before[0], self.after[0]
        return np.asarray(later + (value - later) * self._start + self._reach)

    def derivatives(self) -> tuple[FloatArray, FloatArray]:
        """(8, C, n, T) by the parameters of the keys before and after, and (2, C, n, T) by their
        frames."""
        (value, rise, a), (later, fall, b), (first, second) = self.before, self.after, self._handles
        u, w, gap = self.u, 1.0 - self.u, self.gap
        climb = later - value - b * fall - a * rise
        w2, middle, u2 = w * w, 2.0 * u * w, u * u
        speed = w2 * (a * rise) + middle * climb + u2 * (b * fall)
        steep = speed / (w2 * a + middle * (1.0 - b - a) + u2 * b)  # by x
        by_keys = np.zeros((8, *u.shape))
        by_keys[VALUE], by_keys[4 + VALUE] = self._start, 1.0 - self._start
        by_keys[SLOPE], by_keys[4 + SLOPE] = first * a * gap, -second * b * gap
        by_keys[AFTER], by_keys[4 + BEFORE] = first * (rise - steep), second * (steep - fall)
        by_frames = np.stack([-self._reach - steep * (1.0 - self.x), self._reach - steep * self.x])
        return by_keys, by_frames / gap


def curves(at: FloatArray, parameters: FloatArray, frames: FloatArray) -> Curves:
    """Curves with keys at (C, M) with parameters (C, n, M, 4), at frames (C, T) from the first key
    to the last."""
    spans = (frames[:, :, None] >= at[:, None, 1:-1]).sum(axis=2)
    group = np.arange(len(at))[:, None]
    gap = at[group, spans + 1] - at[group, spans]
    x, gap = ((frames - at[group, spans]) / gap)[:, None], gap[:, None]
    planes, key = np.moveaxis(parameters, 3, 0), spans[None, :, None]
    before = np.take_along_axis(planes[[VALUE, SLOPE, AFTER]], key, axis=3)
    after = np.take_along_axis(planes[[VALUE, SLOPE, BEFORE]], key + 1, axis=3)
    u = _along(x, before[2], after[2])
    before[1] *= gap
    after[1] *= gap
    return Curves(spans, x, gap, before, after, u)


def _along(x: FloatArray, a: FloatArray, b: FloatArray) -> FloatArray:
    """Where along curves time is at a share x of the gap, with handles that reach over shares a of
    it at its start and b at its end."""
    cubic, square, line = 3.0 * (a + b) - 2.0, 3.0 - 3.0 * b - 6.0 * a, 3.0 * a
    cubic_rate, square_rate = 3.0 * cubic, 2.0 * square
    u = np.array(np.broadcast_to(x, a.shape))
    for _ in range(NEWTON_STEPS):
        behind = ((cubic * u + square) * u + line) * u - x
        u -= behind / ((cubic_rate * u + square_rate) * u + line)
    return u
