"""Points of the feet that stand where or as no foot can, frame by frame: to be shown."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np

from ...analysis.performance import Performance, contact_points
from ...arrays import BoolArray, FloatArray
from ...data.contacts import ContactPoint
from ...numerics.runs import runs
from ..falls import Spans
from ..finding import Finding, FindingKind
from .flat_feet import LOW, STANDING_SPEED_UP
from .footing import DRIFT, FLOOR_OFF, HONEST

SHORTEST = 0.1  # s; what is over sooner is a step's own unrest
LEAST_SLID = 0.02  # m from its place; soles that roll do less
SWING = 0.8  # m/s, on its way; a foot that is low and faster swings


class FootFaultKind(Enum):
    """What a point of a foot does that it cannot. The value is the word for it."""

    SLIDES = "slides"
    FLOATS = "floats"
    SINKS = "sinks"


@dataclass(frozen=True)
class FootFault:
    """A point of a foot in the frames first to last (the scene's).

    point: its name, such as "Left heel". bone: that it is fixed to; offset: (3,) m from the bone's
    head, in the bone's axes. amount: m, at its worst.
    """

    kind: FootFaultKind
    point: str
    bone: str
    offset: tuple[float, float, float]
    first: float
    last: float
    amount: float


def find_feet(performance: Performance) -> tuple[FootFault, ...]:
    """The faults of all feet's points, in the order in which they begin.

    performance: as seen from what it stands on, which is at 0 (`as_stood`).
    """
    points, floor = contact_points(performance)
    feet = {n: p for n, p in points.items() if p.kind.is_of_foot}
    lowest = np.min([point.track[:, 2] for point in feet.values()], axis=0)
    found = []
    for name, point in feet.items():
        velocity = np.gradient(point.track, performance.times, axis=0)
        low = point.track[:, 2] - np.maximum(lowest, floor) < LOW
        stands = low & (lowest - floor < LOW) & (np.abs(velocity[:, 2]) < STANDING_SPEED_UP)
        height = point.track[:, 2]
        slides = stands & (np.linalg.norm(velocity[:, :2], axis=1) > DRIFT)
        for kind, wrong in (
            (FootFaultKind.SLIDES, slides),
            (FootFaultKind.FLOATS, stands & (height > FLOOR_OFF)),
            (FootFaultKind.SINKS, height < -FLOOR_OFF),
        ):
            found += _faults(performance, kind, name, point, wrong)
    return tuple(sorted(found, key=lambda fault: fault.first))


def find_sliding_feet(performance: Performance) -> Finding | None:
    """Points of feet that slide further while they stand than honest ones do: the worst, and the
    frames of all."""
    slides = [
        fault
        for fault in find_feet(performance)
        if fault.kind is FootFaultKind.SLIDES and fault.amount > HONEST
    ]
    if not slides:
        return None
    worst = max(slides, key=lambda fault: fault.amount)
    amount = 100.0 * worst.amount
    return Finding(FindingKind.SLIDING_FEET, amount, "cm", _places(slides), worst.point)


def _places(faults: list[FootFault]) -> Spans:
    """The first and last frames of faults in their order, those that overlap as one."""
    places: list[tuple[float, float]] = []
    for fault in faults:
        if places and fault.first <= places[-1][1] + 1.0:
            places[-1] = places[-1][0], max(places[-1][1], fault.last)
        else:
            places.append((fault.first, fault.last))
    return tuple(places)


def _faults(
    performance: Performance, kind: FootFaultKind, name: str, point: ContactPoint, wrong: BoolArray
) -> list[FootFault]:
    frames, least = performance.recording.frames, SHORTEST * performance.recording.rate
    x, y, z = map(float, point.offset)
    found = []
    for first, last in runs(wrong):
        amount = _amount(kind, point.track[first : last + 1])
        fastest = SWING * float(performance.times[last] - performance.times[first])
        slides = kind is FootFaultKind.SLIDES
        if last - first + 1 >= least and (not slides or LEAST_SLID < amount < fastest):
            ends = float(frames[first]), float(frames[last])
            found.append(FootFault(kind, name, point.bone, (x, y, z), *ends, amount))
    return found


def _amount(kind: FootFaultKind, track: FloatArray) -> float:
    """How far, m, a point on its way (T, 3) slides, or is above or below the floor."""
    if kind is FootFaultKind.SLIDES:
        return float(np.linalg.norm(track[-1, :2] - track[0, :2]))
    return float(np.abs(track[:, 2]).max())
