"""How a figure stands: on what height, whether its feet slide, and what carries it unseen."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from ..analysis.performance import Performance, contact_points, find_contacts
from ..arrays import FloatArray
from ..data.contacts import ContactSchedule, Interval, PointKind
from .finding import Finding, FindingKind
from .repairs import Repairs

FLOOR_OFF = 0.03  # m, from the world's 0
LOW = 0.03  # m above the floor: a foot that stands
SLOW = 0.15  # m/s, up or down
ROUNDS = 8  # of narrowing the speeds to the half that agree best
DRIFT = 0.12  # m/s; feet that roll over in runs leave 0.1
ALIKE = 0.75  # of the drift, by which half of all speeds differ from it at most; noise leaves more
LEAST_STANCE = 0.3  # s
FLICKER_GAP = 0.12  # s; a foot cannot leave its place and come back in less
FLICKER_PLACE = 0.03  # m
FLICKERS = 3


def find_footing(performance: Performance) -> list[Finding]:
    """Floor, sliding, flicker, unseen support, and a clip that begins or ends in the air."""
    schedule = find_contacts(performance)
    found = [_floor(performance), _sliding(performance), _flicker(performance, schedule)]
    notes = [
        (FindingKind.UNSEEN_SUPPORT, schedule.unseen),
        (FindingKind.BEGINS_IN_AIR, tuple(f for f in schedule.flights if f.start == 0.0)),
        (
            FindingKind.ENDS_IN_AIR,
            tuple(f for f in schedule.flights if f.end == schedule.duration),
        ),
    ]
    told = [_note(performance, kind, gaps) for kind, gaps in notes if gaps]
    return [finding for finding in found if finding is not None] + told


def _floor(performance: Performance) -> Finding | None:
    """Feet that stand on another height than the world's 0."""
    _, floor = contact_points(performance)
    if abs(floor) <= FLOOR_OFF:
        return None
    return Finding(FindingKind.FLOOR, floor, "m", remedy=Repairs(floor=floor))


def _sliding(performance: Performance) -> Finding | None:
    """Feet that all slide the same way at the same speed: the whole body drifts."""
    speeds = _standing_speeds(performance)
    if len(speeds) < LEAST_STANCE * performance.recording.rate:
        return None
    middle = np.median(speeds, axis=0)
    for _ in range(ROUNDS):
        apart = np.linalg.norm(speeds - middle, axis=1)
        nearest = np.argsort(apart, kind="stable")[: (len(speeds) + 1) // 2]
        middle = np.median(speeds[nearest], axis=0)
    speed = float(np.linalg.norm(middle))
    differ = float(np.median(np.linalg.norm(speeds - middle, axis=1)))
    if speed < DRIFT or differ > ALIKE * speed:
        return None
    x, y = map(float, middle)
    return Finding(FindingKind.SLIDING, speed, "m/s", remedy=Repairs(drift=(x, y)))


def _standing_speeds(performance: Performance) -> FloatArray:
    """(N, 2) m/s, along the floor, of the lowest point of the feet while it stands."""
    points, floor = contact_points(performance)
    feet = [point.track for point in points.values() if point.kind is not PointKind.HAND]
    tracks = np.stack(feet, axis=1)
    velocity = np.gradient(tracks, performance.times, axis=0)
    lowest = np.argmin(tracks[:, :, 2], axis=1), np.arange(len(tracks))
    place, speed = tracks[lowest[1], lowest[0]], velocity[lowest[1], lowest[0]]
    stands = (place[:, 2] - floor < LOW) & (np.abs(speed[:, 2]) < SLOW)
    return np.asarray(speed[stands, :2])


def _flicker(performance: Performance, schedule: ContactSchedule) -> Finding | None:
    """Points that leave their place and come back in less time than a foot can."""
    breaks: list[tuple[Interval, str]] = []
    for point in {contact.point for contact in schedule.contacts}:
        own = [c for c in schedule.contacts if c.point == point]
        for one, other in pairwise(sorted(own, key=lambda c: c.start)):
            same = np.linalg.norm((other.place - one.place)[:2]) < FLICKER_PLACE
            if same and other.start - one.end < FLICKER_GAP:
                breaks.append((Interval(one.end, other.start), point))
    if len(breaks) < FLICKERS:
        return None
    breaks.sort(key=lambda each: each[0].start)
    spans = tuple(_frames(performance, gap) for gap, _ in breaks)
    return Finding(FindingKind.FLICKER, float(len(breaks)), "times", spans, breaks[0][1])


def _note(performance: Performance, kind: FindingKind, gaps: tuple[Interval, ...]) -> Finding:
    seconds = sum(gap.end - gap.start for gap in gaps)
    return Finding(kind, seconds, "s", tuple(_frames(performance, gap) for gap in gaps))


def _frames(performance: Performance, gap: Interval) -> tuple[float, float]:
    """Nearest scene frames of an interval, s."""
    recording = performance.recording
    first = float(recording.frames[0])
    start, end = (float(round(first + t * recording.rate)) for t in (gap.start, gap.end))
    return start, end
