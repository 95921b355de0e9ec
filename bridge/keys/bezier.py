"""Bézier curves as F-curves have them, and how they change with their keys.

A handle's reach is a share of the gap to the next key. At a third on both sides time runs evenly
along the curve, which then is a cubic Hermite spline (`hermite.py`); other shares let one span turn
faster at one end, so that fewer keys are as near to a motion.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...solver.arrays import BoolArray, FloatArray, IntArray

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


class Curves(NamedTuple):
    """C groups of n curves at T frames each, and their derivatives.

    values: (C, n, T). spans: (C, T), the key before each frame. by_keys: (C, n, T, 8) by the
    parameters of the keys before and after it. by_frames: (C, n, T, 2) by their frames.
    """

    values: FloatArray
    spans: IntArray
    by_keys: FloatArray
    by_frames: FloatArray

    def where(self, groups: BoolArray, other: Curves) -> Curves:
        """These of groups (C,) that are true, else the other's."""
        return Curves(
            chosen(groups, self.values, other.values),
            np.where(groups[:, None], self.spans, other.spans),
            chosen(groups, self.by_keys, other.by_keys),
            chosen(groups, self.by_frames, other.by_frames),
        )


def chosen(rows: BoolArray, one: FloatArray, other: FloatArray) -> FloatArray:
    """One's rows where (C,) is true, else the other's."""
    return np.asarray(np.where(rows.reshape(-1, *(1,) * (one.ndim - 1)), one, other))


def curves(at: FloatArray, parameters: FloatArray, frames: FloatArray) -> Curves:
    """Curves with keys at (C, M) with parameters (C, n, M, 4), at frames (C, T) from the first key
    to the last."""
    spans = (frames[:, :, None] >= at[:, None, 1:-1]).sum(axis=2)
    group = np.arange(len(at))[:, None]
    gap = at[group, spans + 1] - at[group, spans]
    x, gap = ((frames - at[group, spans]) / gap)[:, None], gap[:, None]
    each = np.arange(len(at))[:, None, None], np.arange(parameters.shape[1])[None, :, None]
    one, two = (parameters[(*each, spans[:, None] + i)] for i in (0, 1))
    a, b = one[..., AFTER], two[..., BEFORE]
    u = _along(x, a, b)
    w = 1.0 - u
    first, second = 3.0 * u * w**2, 3.0 * u**2 * w  # Bernstein's polynomials of the handles
    start, end = w**3 + first, u**3 + second
    rise, fall = a * gap * one[..., SLOPE], b * gap * two[..., SLOPE]
    reach = first * rise - second * fall
    climb = two[..., VALUE] - one[..., VALUE] - fall - rise
    speed = w**2 * rise + 2.0 * u * w * climb + u**2 * fall
    steep = speed / (w**2 * a + 2.0 * u * w * (1.0 - b - a) + u**2 * b)  # by x
    by_keys = np.zeros((*u.shape, 8))
    by_keys[..., VALUE], by_keys[..., SLOPE] = start, first * a * gap
    by_keys[..., AFTER] = first * (gap * one[..., SLOPE] - steep)
    by_keys[..., 4 + VALUE], by_keys[..., 4 + SLOPE] = end, -second * b * gap
    by_keys[..., 4 + BEFORE] = second * (steep - gap * two[..., SLOPE])
    by_frames = np.stack([-reach - steep * (1.0 - x), reach - steep * x], axis=3) / gap[..., None]
    values = one[..., VALUE] * start + two[..., VALUE] * end + reach
    return Curves(values, spans, by_keys, by_frames)


def _along(x: FloatArray, a: FloatArray, b: FloatArray) -> FloatArray:
    """Where along curves time is at a share x of the gap, with handles that reach over shares a of
    it at its start and b at its end."""
    cubic, square, line = 3.0 * (a + b) - 2.0, 3.0 - 3.0 * b - 6.0 * a, 3.0 * a
    u = np.array(np.broadcast_to(x, a.shape))
    for _ in range(NEWTON_STEPS):
        behind = ((cubic * u + square) * u + line) * u - x
        u -= behind / ((3.0 * cubic * u + 2.0 * square) * u + line)
    return u
