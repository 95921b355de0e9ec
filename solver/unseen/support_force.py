"""Unseen support: what carries the body where nothing that is known does.

A wire, a box, a chair: its place is unknown, so its force and its moment act on the pelvis, as a
harness's would, by forces at three points around it. They know no friction, may pull as well as
push, and are as small as the tracking cost makes them.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import FloatArray, IntArray
from ..body.character import Character
from ..body.kinematics import BodyPoint
from ..data.contacts import ContactSchedule, Interval
from ..numerics.splines import SplineBasis

# s; so long before and after, a foot and what is unseen share the load: no force ends at once.
HAND_OVER = 0.12
# m, from the pelvis's centre of mass to each point: the lever by which a moment is priced.
LEVER = 0.3
N_POINTS = 3


@dataclass(frozen=True)
class SupportForce:
    """Forces at the points of `harness` during intervals, s, which are apart from each other."""

    intervals: tuple[Interval, ...]

    def spans(self, basis: SplineBasis) -> list[IntArray]:
        """Indices of the spans in which it acts, interval by interval."""
        middles = 0.5 * (basis.breaks[:-1] + basis.breaks[1:])
        return [
            np.flatnonzero((middles > each.start) & (middles < each.end)) for each in self.intervals
        ]

    def retimed(self, warp: Callable[[FloatArray], FloatArray]) -> "SupportForce":
        """The same at other instants. warp: new instants (T,) s of old ones."""
        ends = [warp(np.array([each.start, each.end])).tolist() for each in self.intervals]
        return replace(self, intervals=tuple(Interval(*each) for each in ends))


def harness(character: Character) -> tuple[BodyPoint, ...]:
    """Points around the pelvis at which unseen support acts."""
    turned = 2.0 * np.pi * np.arange(N_POINTS) / N_POINTS
    around = LEVER * np.stack([np.cos(turned), np.sin(turned), np.zeros(N_POINTS)], axis=1)
    return tuple(BodyPoint(0, character.bodies[0].com + offset) for offset in around)


def support_force(
    schedule: ContactSchedule, instants: Sequence[float], apart: float
) -> SupportForce | None:
    """What acts where the schedule has unseen support; None where it has none.

    instants: s, at which there are knots; an end that is at most `apart` s from one is there.
    """
    if not schedule.unseen:
        return None
    intervals: list[Interval] = []
    for gap in schedule.unseen:
        before = max((f.end for f in schedule.flights if f.end <= gap.start), default=0.0)
        after = (f.start for f in schedule.flights if f.start >= gap.end)
        start = max(gap.start - HAND_OVER, before)
        end = min(gap.end + HAND_OVER, min(after, default=schedule.duration))
        start, end = (_nearest(t, instants, apart) for t in (start, end))
        if intervals and start <= intervals[-1].end + apart:
            start = intervals.pop().start
        intervals.append(Interval(start, end))
    return SupportForce(tuple(intervals))


def _nearest(time: float, instants: Sequence[float], apart: float) -> float:
    near = min(instants, key=lambda other: abs(other - time))
    return near if abs(near - time) <= apart else time
