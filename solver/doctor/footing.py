"""How a figure stands: on what height, whether its feet slide, and what carries it unseen."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ..analysis.performance import Performance, contact_points, find_contacts
from ..arrays import FloatArray
from ..body.anatomy import Part, Side
from ..data.contacts import ContactSchedule, Interval, PointKind
from .falls import Spans
from .finding import Finding, FindingKind
from .repairs import Repairs

FLOOR_OFF = 0.03  # m, from the world's 0
LOW = 0.03  # m above the floor: a foot that stands
SLOW = 0.15  # m/s, up or down
ROUNDS = 8  # of narrowing the speeds to the half that agree best
DRIFT = 0.12  # m/s; feet that roll over in runs leave 0.1
ALIKE = 0.75  # of the drift, by which half of all speeds differ from it at most; noise leaves more
LEAST_STANCE, LEAST_STANDING = 0.3, 12  # s, and frames: half of fewer slide alike by chance
LEAST_SHARE = 0.1  # of a clip, in which something stands, likewise: a dance's few moments turn feet
RISE = 0.06  # m/s, of feet that stand; 0.3 s and more of honest ones leave 0.04
LEAST_LEVEL = 0.3  # s of feet that stand flat, of which so much can be told
FLAT = 0.06  # m/s, by which both ends of a foot that stands flat differ
ALIKE_RISE = 0.5  # of the rise, likewise
FLICKER_GAP = 0.12  # s; a foot cannot leave its place and come back in less
FLICKER_PLACE = 0.03  # m
FLICKERS = 3


def find_footing(
    performance: Performance, schedule: ContactSchedule | None = None
) -> list[Finding]:
    """Floor, sliding, flicker, unseen support, and a clip that begins or ends in the air.

    performance: as seen from what it stands on. schedule: its contacts, with the scene's ground;
    None for those with the floor alone.
    """
    schedule = find_contacts(performance) if schedule is None else schedule
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
    rate, share = performance.recording.rate, LEAST_SHARE * len(performance.times)
    if len(speeds) < max(LEAST_STANCE * rate, share, LEAST_STANDING):
        return None
    middle, differ = _agreed(speeds)
    speed = float(np.linalg.norm(middle))
    if speed < DRIFT or differ > ALIKE * speed:
        return None
    x, y = map(float, middle)
    return Finding(FindingKind.SLIDING, speed, "m/s", remedy=Repairs(drift=(x, y)))


def find_rise(performance: Performance) -> Finding | None:
    """Feet that all rise, or sink, at the same speed while they stand: the whole body drifts. Who
    climbs has feet that stand still. performance: in its right size and time."""
    speeds = _flat_speeds(performance)
    if len(speeds) < LEAST_LEVEL * performance.recording.rate:
        return None
    (rise,), differ = _agreed(speeds[:, None])
    if abs(rise) < RISE or differ > ALIKE_RISE * abs(rise):
        return None
    return Finding(FindingKind.RISING, float(rise), "m/s", remedy=Repairs(rise=float(rise)))


def _flat_speeds(performance: Performance) -> FloatArray:
    """(N,) m/s, upwards, of feet while they neither turn nor go. By their joints: where contact
    points are hangs on the floor, and of one that rises no height is known."""
    found = []
    for side in (Side.LEFT, Side.RIGHT):
        ankle, ball = (
            np.gradient(track, performance.times, axis=0) for track in _ends(performance, side)
        )
        middle = 0.5 * (ankle + ball)
        flat = np.linalg.norm(ankle - ball, axis=1) < FLAT
        flat &= np.linalg.norm(middle[:, :2], axis=1) < SLOW
        found.append(middle[flat, 2])
    return np.concatenate(found)


def _ends(performance: Performance, side: Side) -> tuple[FloatArray, FloatArray]:
    """(T, 3) m each, of a foot's ankle and ball; of one without toes of its bone's end."""
    character, centres = performance.character, performance.centres
    foot, toe = (character.body(part, side) for part in (Part.FOOT, Part.TOE))
    assert foot is not None
    if toe is not None:
        return centres[:, foot], centres[:, toe]
    tip = performance.rotations[:, foot] @ character.bodies[foot].tip
    return centres[:, foot], centres[:, foot] + tip


def _agreed(speeds: FloatArray) -> tuple[FloatArray, float]:
    """The speed (D,), m/s, about which the half of some (N, D) that agree best are, and how far, in
    the median, all differ from it."""
    middle = np.median(speeds, axis=0)
    for _ in range(ROUNDS):
        apart = np.linalg.norm(speeds - middle, axis=1)
        nearest = np.argsort(apart, kind="stable")[: (len(speeds) + 1) // 2]
        middle = np.median(speeds[nearest], axis=0)
    return middle, float(np.median(np.linalg.norm(speeds - middle, axis=1)))


def _standing_speeds(performance: Performance) -> FloatArray:
    """(N, 2) m/s, along the floor, of the lowest point of the feet while it stands."""
    return standing(performance).velocities[:, :2]


@dataclass(frozen=True)
class LowestPoint:
    """Of the feet, while it stands, N samples: s, m and m/s."""

    times: FloatArray
    places: FloatArray
    velocities: FloatArray


def standing(performance: Performance) -> LowestPoint:
    """When, where and how fast the lowest point of the feet stands, near its floor."""
    points, floor = contact_points(performance)
    feet = [point.track for point in points.values() if point.kind is not PointKind.HAND]
    tracks = np.stack(feet, axis=1)
    velocity = np.gradient(tracks, performance.times, axis=0)
    lowest = np.argmin(tracks[:, :, 2], axis=1), np.arange(len(tracks))
    place, speed = tracks[lowest[1], lowest[0]], velocity[lowest[1], lowest[0]]
    stands = (place[:, 2] - floor < LOW) & (np.abs(speed[:, 2]) < SLOW)
    return LowestPoint(performance.times[stands], place[stands], speed[stands])


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
    spans = spans_of(performance, (gap for gap, _ in breaks))
    return Finding(FindingKind.FLICKER, float(len(breaks)), "times", spans, breaks[0][1])


def spans_of(performance: Performance, gaps: Iterable[Interval]) -> Spans:
    """Nearest first and last scene frames of intervals, s."""
    return tuple(_frames(performance, gap) for gap in gaps)


def _note(performance: Performance, kind: FindingKind, gaps: tuple[Interval, ...]) -> Finding:
    seconds = sum(gap.end - gap.start for gap in gaps)
    return Finding(kind, seconds, "s", spans_of(performance, gaps))


def _frames(performance: Performance, gap: Interval) -> tuple[float, float]:
    """Nearest scene frames of an interval, s."""
    recording = performance.recording
    first = float(recording.frames[0])
    start, end = (float(round(first + t * recording.rate)) for t in (gap.start, gap.end))
    return start, end
