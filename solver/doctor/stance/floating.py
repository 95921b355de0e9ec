"""The whole body floats about, slowly, while its feet stand: as capture by one camera has it, which
sees neither depth nor the floor."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ...arrays import BoolArray, FloatArray
from ...data.problem import Mend
from ...data.recording import Recording
from ...numerics.runs import runs
from ...numerics.splines import SplineBasis, SplineTerm
from ..figure import Figure
from ..finding import Finding, FindingKind
from ..repairs import Repairs
from .flat_feet import flat_feet

# Heights of feet that stand differ, from the tenth lowest to the tenth highest of a hundred: those
# of honest feet by 1.5 cm; and how fast they move, where those on stairs stand still.
RISES, RISES_BY = 0.03, 0.03  # m, and m/s
STEP = 0.15  # m; what the ground's way leaves of such differences is a stair's, or a box's
# Where feet stand shortly their velocities tell little of the way between, and it leaves as much on
# a level floor. To be level it must then go by some 0.6 to 1.2 cm/s, rms, otherwise than without
# these heights, and by 1.5 to 6 where one is a box's.
PULLED = 0.013  # m/s
OUTER = 10.0, 90.0  # %
SLIDES = 0.06  # m along the floor, of a foot in one stance; honest ones move by 2 to 4 cm
SLIDE_SHARE = 1.0 / 3.0  # of the time in which feet stand; one may be drawn along the floor
LEAST_STANDING = 0.3  # s
LIFTED = 0.03  # m, above the other foot, whether that is flat or not
FEWEST = 3  # frames, of which velocities can be told
STILL = 0.1  # m/s; of two feet that differ by more one is drawn along the floor
# Of the way that is taken out: feet tell its velocities to 2 cm/s and its heights to 1 cm; where
# none does, what floats is likely within 10 cm and as fast as 15 cm/s.
KNOT = 0.25  # s; what floats takes a second or more
STIFF = 0.1**4  # s⁴, of the velocities' second derivative, against what they miss the feet's by
HEIGHT_WEIGHT = (0.02 / 0.01) ** 2  # 1/s², of heights, likewise
PLACE_WEIGHT = (0.02 / 0.1) ** 2  # 1/s², of places
APART_WEIGHT = (0.02 / 0.05) ** 2  # 1/s², likewise where a box's height hides how far it floated
VELOCITY_WEIGHT = (0.02 / 0.15) ** 2  # of velocities where no foot tells any, likewise


def find_floating(recording: Recording, figure: Figure) -> Finding | None:
    """Feet that stand flat move, up and down or along the floor, and more than feet do.

    recording: in its right size and time, and without drift of one speed.
    """
    ground = _Ground.of(recording, figure)
    far = max(ground.rises(), ground.slides())
    if far == 0.0:
        return None
    return Finding(FindingKind.FLOATING, 100.0 * far, "cm", remedy=Repairs(mend=(Mend.FLOATING,)))


def held_to_the_ground(recording: Recording, figure: Figure) -> Recording:
    """With the whole body moved, slowly, so that feet that stand flat and rise are on one floor, at
    the middle of their heights, or on boxes each stay level, and those that slide stay where they
    are; others as they are."""
    if len(recording.frames) < FEWEST:
        return recording
    ground = _Ground.of(recording, figure)
    moves = np.array([ground.slides() > 0.0, ground.slides() > 0.0, ground.rises() > 0.0])
    if not moves.any():
        return recording
    way = np.where(moves, ground.way, 0.0)
    return replace(recording, heads=recording.heads - way[:, None])


@dataclass(frozen=True)
class _Ground:
    """What flat feet tell of the ground's way: its velocity (T, 3), m/s, and its height (T,), m,
    both 0 where none does, and where one does (T,). rate: frames a second."""

    velocity: FloatArray
    height: FloatArray
    tells: BoolArray
    rate: float

    @staticmethod
    def of(recording: Recording, figure: Figure) -> _Ground:
        """By the mean of both feet, or by the one that stands: the lower one, or the stiller."""
        feet, rate = list(flat_feet(recording, figure)), recording.rate
        heights = np.stack([foot.track[:, 2] for foot in feet])
        stands = np.array([foot.stands(rate) for foot in feet])
        stands &= heights < heights.min(axis=0) + LIFTED
        velocities = np.stack([foot.velocity for foot in feet])
        speeds = np.where(stands, np.linalg.norm(velocities, axis=2), np.inf)
        stands &= speeds < speeds.min(axis=0) + STILL
        share = stands / np.maximum(stands.sum(axis=0), 1)
        velocity = np.einsum("ft,fti->ti", share, velocities)
        height = np.asarray(np.sum(share * heights, axis=0))
        return _Ground(velocity, height, stands.any(axis=0), rate)

    def rises(self) -> float:
        """How far, m, the ground goes up and down below feet that stand; 0 where it does not, or
        where these feet stand still."""
        seconds = float(self.tells.sum()) / self.rate
        if seconds < LEAST_STANDING:
            return 0.0
        far = self._spread(self.height if self.is_one_floor else self.way[:, 2])
        climbed = sum(float(np.ptp(way[:, 2])) for way in self._stances)
        return far if far > RISES and climbed > RISES_BY * seconds else 0.0

    def slides(self) -> float:
        """How far, m, feet slide in a stance at most; 0 where they do so for less than a third of
        the time in which they stand."""
        ways, frames = self._stances, float(self.tells.sum())
        slid = [float(np.linalg.norm(np.ptp(way[:, :2], axis=0))) for way in ways]
        sliding = sum(len(way) for way, far in zip(ways, slid, strict=True) if far > SLIDES)
        floats = frames >= LEAST_STANDING * self.rate and sliding > SLIDE_SHARE * frames
        return max(slid) if floats else 0.0

    @cached_property
    def _stances(self) -> list[FloatArray]:
        """(n, 3) m, the ground's way in each part in which it is told."""
        parts = (self.velocity[first : last + 1] for first, last in runs(self.tells))
        return [np.cumsum(part, axis=0) / self.rate for part in parts]

    @cached_property
    def is_one_floor(self) -> bool:
        """Whether the ground's way alone is why heights differ, and no box on which some stand: it
        explains them, or takes them with hardly other velocities below these feet."""
        free = self._free_way[:, 2]
        if self._spread(self.height - free) < STEP:
            return True
        pulled = (np.gradient(self._level_way - free) * self.rate)[self.tells]
        return bool(np.sqrt(np.mean(pulled**2)) < PULLED)

    @cached_property
    def way(self) -> FloatArray:
        """(T, 3) m, the way with these velocities, and on one floor with these heights."""
        up = self._level_way if self.is_one_floor else self._way(APART_WEIGHT)[:, 2]
        return np.column_stack([self._free_way[:, :2], up])

    @cached_property
    def _free_way(self) -> FloatArray:
        """(T, 3) m, the way by these velocities alone."""
        return self._way(PLACE_WEIGHT)

    @cached_property
    def _level_way(self) -> FloatArray:
        """(T,) m, the way upwards if all heights are of one floor."""
        floor = np.median(self.height[self.tells])
        above = np.repeat((self.height - floor)[:, None], 3, axis=1)
        level = SplineTerm(0, HEIGHT_WEIGHT * self.tells, above)
        return self._way(PLACE_WEIGHT, level)[:, 2]

    def _spread(self, heights: FloatArray) -> float:
        """M, by which heights (T,), m, differ where feet stand."""
        low, high = np.percentile(heights[self.tells], OUTER)
        return float(high - low)

    def _way(self, place_weight: float, *more: SplineTerm) -> FloatArray:
        """(T, 3) m: least squares of a spline with its third derivative (a P-spline, Eilers and
        Marx 1996), by the velocities and more. place_weight: 1/s²."""
        times = np.arange(len(self.tells)) / self.rate
        breaks = np.linspace(0.0, times[-1], max(round(times[-1] / KNOT), 1) + 1)
        basis = SplineBasis(breaks, np.zeros(len(breaks), bool))
        one, nothing = np.ones(len(times)), 0.0 * self.velocity
        terms = [
            SplineTerm(0, place_weight * one, nothing),
            SplineTerm(1, np.where(self.tells, one, VELOCITY_WEIGHT), self.velocity),
            SplineTerm(3, STIFF * one, nothing),
            *more,
        ]
        return basis.combine(basis.least_squares(times, terms), times)
