"""Rides: what stands on an object that moves goes with its surface.

The world's frame is inertial, so a platform enters by where contacts are held, how fast and with
which normal, and nowhere else: no fictitious forces.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..arrays import FloatArray
from ..numerics.rigid_motion import Poses
from ..scene.object_motion import ObjectMotion


@dataclass(frozen=True)
class Ride:
    """Rigid motion of what stands on moving ground, from where it stands at `since`, s.

    share: how fast the ground moves, of its own speed; for homotopies.
    """

    ground: ObjectMotion
    since: float
    share: float = 1.0

    @cached_property
    def _back(self) -> tuple[FloatArray, FloatArray]:
        """Rotation (3, 3) and place (3,) m of the ground at `since`."""
        at = self.ground.surface(np.array([self.since]))
        return at.turn[0], at.shift[0]

    def _relative(self, at: Poses) -> Poses:
        turn, place = self._back
        whole = at.turn @ turn.T
        return Poses(whole, at.shift - whole @ place)

    def poses(self, times: FloatArray) -> Poses:
        """World to world: from places at `since` to where the ground carries them by (T,) s."""
        return self._relative(self.ground.surface(self._slowed(times)))

    def back(self, times: FloatArray, points: FloatArray) -> FloatArray:
        """Where points (T, 3) m at instants (T,) s were at `since`, on the ground."""
        return self.poses(times).back(points)

    def rates(self, times: FloatArray) -> Poses:
        """Rates of change of `poses`."""
        rate = self._relative(self.ground.surface_rates(self._slowed(times)))
        return Poses(self.share * rate.turn, self.share * rate.shift)

    def velocity(self, place: FloatArray, time: float) -> FloatArray:
        """(3,) m/s of the ground where it is at a place (3,) m, at an instant, s."""
        at, rate = self.poses(np.array([time])), self.rates(np.array([time]))
        back = at.turn[0].T @ (place - at.shift[0])
        return np.asarray(rate.of(back)[0])

    def _slowed(self, times: FloatArray) -> FloatArray:
        return np.asarray(self.since + self.share * (times - self.since))

    def slowed(self, share: float) -> Ride:
        """The same ground at a share of its own speed."""
        return replace(self, share=share)

    def retimed(self, warp: Callable[[FloatArray], FloatArray]) -> Ride:
        """The ride of a stance that begins at another instant; the ground's clock stays."""
        return replace(self, since=float(warp(np.array([self.since]))[0]))
