"""What the keys of a motion must show: contacts, and frames of which the whole body gets a key."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...solver.arrays import FloatArray
from ...solver.data.contacts import ContactSchedule, PhaseKind


@dataclass(frozen=True)
class PlantedPoint:
    """Point of a bone that stays in its place between two frames.

    offset: (3,) m from the bone's head, in the bone's axes.
    """

    bone: str
    offset: FloatArray
    first: float
    last: float


@dataclass(frozen=True)
class KeyEvents:
    """What keys must show: points that stand, and frames of which the whole body gets a key."""

    planted: tuple[PlantedPoint, ...] = ()
    columns: tuple[float, ...] = ()

    @property
    def extremes(self) -> FloatArray:
        """Frames (n,), whole or not, of columns and of edges of contacts."""
        edges = (frame for point in self.planted for frame in (point.first, point.last))
        return np.array([*self.columns, *edges])


def events_of(schedule: ContactSchedule, first_frame: float, rate: float) -> KeyEvents:
    """Contacts, take-offs, landings and the middles of flights as events.

    first_frame: scene frame of the schedule's start. rate: frames a second.
    """

    def frame(seconds: float) -> float:
        return first_frame + rate * seconds

    planted = tuple(
        PlantedPoint(c.bone, c.offset, frame(c.start), frame(c.end)) for c in schedule.contacts
    )
    flights = [p for p in schedule.phases if p.kind is PhaseKind.FLIGHT]
    columns = [t for p in flights for t in (p.start, (p.start + p.end) / 2.0, p.end)]
    return KeyEvents(planted, tuple(map(frame, columns)))
