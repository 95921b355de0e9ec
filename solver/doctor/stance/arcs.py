"""How high a body is of which the pose alone is known: it is on what is lowest, or it falls."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...arrays import FloatArray
from ...data.constants import STANDARD_GRAVITY

SHORTEST, LONGEST = 0.06, 1.2  # s, of a flight; a rise of 1.8 m
STANCE = 0.08  # s, between two of them at least; a sprinter's lasts 0.1 s
SLOPE = 0.05  # s, by which the speed is told with which the ground is left, and met
BENT = 1.0 / 60.0  # s, on both sides, by which an acceleration is
HARDEST = 5.0 * STANDARD_GRAVITY  # m/s² upwards, of a landing
# In (m/s)², as of speeds that an arc misses: for each m/s by which feet pull at the ground, or push
# harder, and of a flight up to an end of the clip, which misses none there. Speeds that are missed
# by more than ROUGHLY, m/s, are told badly, and count by that factor alone.
STANDING, OPEN, ROUGHLY = 1.0, 0.2, 1.0
UNDER = 0.01  # m, by which an arc may be lower than the legs allow


def with_arcs(above: FloatArray, rate: float) -> FloatArray:
    """Heights of the centre of mass over the ground, (T,) m.

    above: (T,) m, how far it is above what is lowest of the body, at so many frames a second. No
    foot pulls at the ground: where the legs' height would sink faster than by gravity the body
    flies, on a parabola with the speeds of before and after. The parting of a clip into both is the
    one that misses these, and pulls, least, by dynamic programming.
    """
    legs, stance = _Legs.of(above, rate), max(round(STANCE * rate), 2)
    price, leaving = np.zeros(len(above)), np.zeros(len(above))  # of the ways to there
    arcs = list[_Arc | None]([None] * len(above))
    for frame in range(1, len(above)):
        price[frame] = price[frame - 1] + legs.price[frame]
        for flights in (legs.begun_in_air(frame), legs.landing(frame, leaving)):
            if (arc := legs.cheapest(flights, price[frame])) is not None:
                price[frame], arcs[frame] = arc.price, arc
        since = max(frame - stance, 0)
        standing = legs.stood[frame] - legs.stood[since] - legs.left(frame)
        leaving[frame] = price[since] + standing
    heights, frame = above.copy(), len(above) - 1
    arcs[frame] = legs.cheapest(legs.ending_in_air(leaving), price[frame]) or arcs[frame]
    while frame > 0:
        arc = arcs[frame]
        if arc is not None:
            heights[arc.first : arc.last + 1] = legs.along(arc)
        frame = frame - 1 if arc is None else arc.first - stance
    return heights


@dataclass(frozen=True)
class _Arc:
    """From a frame to a frame, with the speed, m/s, that it has at one of them, and its price with
    that of all before it."""

    first: int
    last: int
    known: int
    speed: float
    price: float


@dataclass(frozen=True)
class _Legs:
    """As far as they hold the centre of mass above the ground, (T,) m, its speeds, m/s, told from
    before each frame and from after it, and the price of standing there, up to it in all, which is
    told by so many frames on both sides."""

    above: FloatArray
    rate: float
    before: FloatArray
    after: FloatArray
    price: FloatArray
    stood: FloatArray
    reach: int

    @staticmethod
    def of(above: FloatArray, rate: float) -> _Legs:
        reach, price = max(round(BENT * rate), 1), np.zeros(len(above))
        if len(above) > 2 * reach:
            bent = above[2 * reach :] - 2.0 * above[reach:-reach] + above[: -2 * reach]
            acceleration = bent * (rate / reach) ** 2
            beyond = acceleration - np.clip(acceleration, -STANDARD_GRAVITY, HARDEST)
            price[reach:-reach] = STANDING * np.abs(beyond) / rate
        before, after = _slopes(above, rate), -_slopes(above[::-1], rate)[::-1]
        return _Legs(above, rate, before, after, price, np.cumsum(price), reach)

    def left(self, first: int) -> float:
        """The price of standing that frames seem to have before a flight, by what follows."""
        return float(self.price[max(first - self.reach + 1, 0) : first + 1].sum())

    def met(self, last: int) -> float:
        """The same after one, by what was before."""
        return float(self.price[last + 1 : last + self.reach].sum())

    def landing(self, last: int, leaving: FloatArray) -> Iterator[_Arc]:
        """Flights that land at a frame, the cheapest first. leaving: (T,) prices of the ways to
        frames before it that end with a stance."""
        shortest, longest = self._frames
        firsts = np.arange(max(last - longest, 0), last - shortest + 1)
        seconds = (last - firsts) / self.rate
        mean, gained = (self.above[last] - self.above[firsts]) / seconds, 0.5 * seconds
        speeds = mean + STANDARD_GRAVITY * gained
        lands = mean - STANDARD_GRAVITY * gained
        missed = np.abs([speeds - self.before[firsts], lands - self.after[last]])
        prices = leaving[firsts] + (missed**2 / (1.0 + missed / ROUGHLY)).sum(axis=0)
        prices -= self.met(last)
        for i in np.argsort(prices, kind="stable"):
            first = int(firsts[i])
            yield _Arc(first, last, first, float(speeds[i]), float(prices[i]))

    def begun_in_air(self, last: int) -> Iterator[_Arc]:
        """The one from the clip's beginning that lands at a frame."""
        shortest, longest = self._frames
        if shortest <= last <= longest:
            yield _Arc(0, last, last, float(self.after[last]), OPEN - self.met(last))

    def ending_in_air(self, leaving: FloatArray) -> Iterator[_Arc]:
        """Those that go on to the clip's end, likewise."""
        shortest, longest = self._frames
        end = len(self.above) - 1
        firsts = np.arange(max(end - longest, 0), end - shortest + 1)[::-1]  # as late as may be
        for first in firsts[np.argsort(leaving[firsts], kind="stable")].tolist():
            yield _Arc(first, end, first, float(self.before[first]), leaving[first] + OPEN)

    def cheapest(self, arcs: Iterator[_Arc], price: float) -> _Arc | None:
        """The first of them that is below a price and is nowhere lower than the legs allow."""
        for arc in arcs:
            if arc.price >= price:
                return None
            if (self.along(arc) > self.above[arc.first : arc.last + 1] - UNDER).all():
                return arc
        return None

    def along(self, arc: _Arc) -> FloatArray:
        """Heights, m, of its frames."""
        seconds = (np.arange(arc.first, arc.last + 1) - arc.known) / self.rate
        fallen = 0.5 * STANDARD_GRAVITY * seconds**2
        return np.asarray(self.above[arc.known] + arc.speed * seconds - fallen)

    @property
    def _frames(self) -> tuple[int, int]:
        """Fewest and most of a flight."""
        return max(round(SHORTEST * self.rate), 2), round(LONGEST * self.rate)


def _slopes(heights: FloatArray, rate: float) -> FloatArray:
    """(T,) m/s, at each frame, of a parabola through it and those before it."""
    reach = max(round(SLOPE * rate), 2)
    since = np.arange(-reach, 1) / rate
    weights = np.linalg.pinv(np.vander(since, 3))[1]
    padded = np.pad(heights, (reach, 0), mode="edge")
    return np.asarray(np.lib.stride_tricks.sliding_window_view(padded, reach + 1) @ weights)
