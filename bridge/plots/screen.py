"""Rectangles on the screen, and linear axes from values to pixels."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, floor, log10

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float32]

STEPS = (1.0, 2.0, 5.0, 10.0)


@dataclass(frozen=True)
class Rect:
    """A rectangle, px, from the region's lower left corner."""

    left: float
    bottom: float
    right: float
    top: float

    @property
    def width(self) -> float:
        return self.right - self.left

    @property
    def height(self) -> float:
        return self.top - self.bottom

    def holds(self, x: float, y: float) -> bool:
        """Point-in-rectangle test."""
        return self.left <= x <= self.right and self.bottom <= y <= self.top


@dataclass(frozen=True)
class Axis:
    """Maps values linearly: `first` is at px `start`, `last` at `end`. first != last."""

    first: float
    last: float
    start: float
    end: float

    @property
    def per_unit(self) -> float:
        """px for each unit of value."""
        return (self.end - self.start) / (self.last - self.first)

    def at(self, value: float) -> float:
        """px at which a value is."""
        return self.start + (value - self.first) * self.per_unit

    def all_at(self, values: ArrayLike) -> Array:
        """px of many values, (N,)."""
        away = np.asarray(values, dtype=float) - self.first
        return np.asarray(self.start + away * self.per_unit, np.float32)

    def value(self, px: float) -> float:
        """The value at px."""
        return self.first + (px - self.start) / self.per_unit

    def ticks(self, apart: float, finest: float = 0.0) -> tuple[float, ...]:
        """Round values on the axis, at least `apart` px and `finest` in value from each other."""
        low, high = min(self.first, self.last), max(self.first, self.last)
        step = max(round_step(apart / abs(self.per_unit)), finest)
        counts = range(ceil(low / step - 1e-6), floor(high / step + 1e-6) + 1)
        return tuple(step * count + 0.0 for count in counts)


def round_step(least: float) -> float:
    """The smallest of ..., 0.1, 0.2, 0.5, 1, 2, 5, 10, ... that is not below `least` (> 0)."""
    decade = 10.0 ** floor(log10(least))
    return next(step * decade for step in STEPS if step * decade >= least * (1.0 - 1e-9))


def round_range(low: float, high: float, parts: int) -> tuple[float, float]:
    """The range widened to round values, so that about `parts` steps fill it."""
    spread = high - low if high > low else max(abs(high), 1.0)
    step = round_step(spread / parts)
    bottom = floor(low / step + 1e-6)
    return step * bottom, step * max(ceil(high / step - 1e-6), bottom + 1)
