"""How a figure stands: on what height, whether its feet slide, and what carries it unseen."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ...analysis.balance import SURELY_LASTS, off_balance
from ...analysis.carried_by import skids_in
from ...analysis.performance import Performance, contact_points, find_contacts
from ...arrays import FloatArray
from ...contacts.noisy_touches import MAX_BREAK
from ...data.contacts import ContactSchedule, Interval
from ...data.recording import Recording
from ...scene.support import boxes_beneath
from ..falls import Spans
from ..figure import Figure
from ..finding import Finding, FindingKind
from ..repairs import Repairs
from .flat_feet import FLAT_SPEED, LOW, STANDING_SPEED_UP, FlatSamples, agreed
from .sinking import find_sinking
from .to_and_fro import go_against
from .trembling_feet import drift_of_stances

FLOOR_OFF = 0.03  # m, from the world's 0
TOP_OFF = 0.05  # m, likewise, of a box: how thick soles are is told by a floor at 0 alone
NEAR = 0.2  # m above the floor, where a foot still stands that sinks to it
UNEVEN = 0.02  # m, standard deviation of where feet stand; of honest ones on one floor up to 0.01
STRAIGHT = 0.3  # of that, which is left without the rise; two stances on a stair's steps leave 0.5
FEWEST_STANCES = 3
DRIFT = 0.12  # m/s; feet that roll over in runs leave 0.1
FLAT_FAST = 0.8 * FLAT_SPEED  # m/s, of which feet that stand flat no longer tell
FLAT_DRIFT = 0.04  # m/s, of feet that stand flat; honest ones leave 0.014
APART = 0.1  # s, and a frame: what stands after it stands anew
HONEST = 0.03  # m, by which feet go in a stance; as their load shifts they roll and turn
LEAST_SLID = 0.06  # m, in all stances, likewise
TOLD_WITHIN = 0.25  # of a drift's way in a stance; feet that roll on a belt leave as much
# Likewise of several stances together, of which one or another rolls further: by chance four leave
# as little in one of a thousand cases (Hotelling's T²).
SEVERAL, TOLD_BY_ALL = 4, 1.0 / 3.0
ALIKE = 0.75  # of the drift, by which half of all speeds differ from it at most; noise leaves more
LEAST_STANCE, LEAST_STANDING = 0.3, 12  # s, and frames: half of fewer slide alike by chance
LEAST_SHARE = 0.1  # of a clip, in which something stands, likewise: a dance's few moments turn feet
RISE = 0.04  # m/s, of feet that stand; half a second and more of honest ones leaves 0.01
LEAST_LEVEL = 0.3  # s of feet that stand flat, of which so much can be told
ALIKE_RISE = 0.5  # of the rise, likewise
STEADY = 0.5  # of the speed, by which those of half a clip may differ
LEVELLED = 0.5  # of how much their heights differ, that is left without the rise
FLICKER_PLACE = 0.03  # m
FLICKERS = 3


def find_footing(
    performance: Performance, schedule: ContactSchedule | None = None
) -> list[Finding]:
    """Floor, feet below it, flicker, unseen support, feet that skid, weight beside them, and
    a clip that begins or ends in the air.

    performance: as seen from what it stands on. schedule: its contacts, with the scene's ground;
    None for those with the floor alone.
    """
    schedule = find_contacts(performance) if schedule is None else schedule
    found = [
        _floor(performance, schedule),
        find_sinking(performance),
        _flicker(performance, schedule),
    ]
    skids = skids_in(performance, schedule.unseen)
    notes = [
        (FindingKind.UNSEEN_SUPPORT, tuple(u for u in schedule.unseen if u not in skids)),
        (FindingKind.SKIDDING, skids),
        (FindingKind.OFF_BALANCE, off_balance(performance, schedule, SURELY_LASTS)),
        (FindingKind.BEGINS_IN_AIR, tuple(f for f in schedule.flights if f.start == 0.0)),
        (
            FindingKind.ENDS_IN_AIR,
            tuple(f for f in schedule.flights if f.end == schedule.duration),
        ),
    ]
    told = [_note(performance, kind, gaps) for kind, gaps in notes if gaps]
    return [finding for finding in found if finding is not None] + told


def _floor(performance: Performance, schedule: ContactSchedule) -> Finding | None:
    """Feet that stand on another height than the world's 0, or sink to it. Where nothing stands
    there is no floor: that of contacts is then the lowest that feet reach in the air. Who also
    stands at 0, unseen, or on an object of the scene, jumps down from there: moved, the recording
    would leave that."""
    if not schedule.contacts and not schedule.unseen:
        return None
    if any(contact.on is not None for contact in schedule.contacts):
        return None
    points, floor = contact_points(performance)
    boxes = (b for u in schedule.unseen for b in boxes_beneath(performance.times, points, u, floor))
    is_off = abs(floor) > FLOOR_OFF
    if is_off and any(abs(box.top) <= TOP_OFF for box in boxes):
        return None
    level = Repairs(floor=floor) if is_off else None
    rise = _rise_to_floor(performance)
    if rise is not None:
        return Finding(
            FindingKind.RISING, rise, "m/s", remedy=Repairs(rise=rise), alternative=level
        )
    return Finding(FindingKind.FLOOR, floor, "m", remedy=level) if is_off else None


def _rise_to_floor(performance: Performance) -> float | None:
    """M/s, at which feet rise, or sink, that stand near the floor, within their stances and from
    one to the next: where they stand flat for too short a time for `find_rise`, as in a run. On
    stairs they stand still, and two short stances may be on anything."""
    near = standing(performance, NEAR)
    slow = np.linalg.norm(near.velocities[:, :2], axis=1) < FLAT_SPEED
    times, heights = near.times[slow], near.places[slow, 2]
    if len(times) < LEAST_STANDING or np.std(heights) < UNEVEN:
        return None
    apart = APART + 1.0 / performance.recording.rate
    stances = _Slides.of(times, near.velocities[slow], apart).seconds
    rise = float(np.polyfit(times, heights, 1)[0])
    told = len(stances) >= FEWEST_STANCES or max(stances) > LEAST_LEVEL
    steady = abs(rise) > RISE and np.std(heights - rise * times) < STRAIGHT * np.std(heights)
    return rise if told and steady else None


def find_sliding(performance: Performance, figure: Figure) -> Finding | None:
    """Feet that in all stances slide the same way at the same speed: the whole body drifts. By the
    lowest points of feet, by feet that stand flat, which tell less of a drift, or first, where feet
    tremble, by whole stances. What sways is as fast for a while, but feet go against it, too.

    performance: as seen from what it stands on, in its right size and time.
    """
    rate, share = performance.recording.rate, LEAST_SHARE * len(performance.times)
    flat, lowest = (
        _Slides.of(each.times, each.velocities, APART + 1.0 / rate)
        for each in (FlatSamples.of(performance.recording, figure), standing(performance))
    )
    least = max(LEAST_STANCE * rate, share, LEAST_STANDING)
    trembling = told = drift_of_stances(performance.recording, figure)
    if told is None and len(flat.speeds) >= least:
        told = _drift(flat, FLAT_DRIFT)
    if told is None and len(lowest.speeds) >= least:
        slowest = FLAT_FAST if len(flat.speeds) >= least else DRIFT
        told = _drift(lowest, slowest)
    if told is None:
        return None
    speed = float(np.hypot(*told))
    # What feet that stand flat tell of a slower one, lowest points, which roll, cannot deny.
    if (trembling or speed > DRIFT) and go_against(performance, told):
        return None
    return Finding(FindingKind.SLIDING, speed, "m/s", remedy=Repairs(drift=told))


@dataclass(frozen=True)
class _Slides:
    """How feet slide while they stand: speeds (N, 2), m/s, in their order, and of each of S stances
    how long it lasts, (S,) s, and its own speed, (S, 2) m/s."""

    speeds: FloatArray
    seconds: FloatArray
    own: FloatArray

    @staticmethod
    def of(times: FloatArray, velocities: FloatArray, apart: float) -> _Slides:
        """times: (N,) s, in order. velocities: (N, 3) m/s. apart: s, from a stance to the next."""
        cuts, speeds = np.flatnonzero(np.diff(times) > apart) + 1, velocities[:, :2]
        if not len(times):
            return _Slides(speeds, np.zeros(0), np.zeros((0, 2)))
        seconds = np.array([np.ptp(stance) for stance in np.split(times, cuts)])
        own = np.array([np.median(stance, axis=0) for stance in np.split(speeds, cuts)])
        return _Slides(speeds, seconds, own)

    def tell(self, drift: FloatArray) -> bool:
        """Whether they slide so far in all that honest feet do not, and without the drift (2,),
        m/s, in each stance no further than these, or together far less than with it: one that is
        short tells too little alone."""
        speed = float(np.linalg.norm(drift))
        slid = speed * self.seconds
        left = np.linalg.norm(self.own - drift, axis=1) * self.seconds
        agree = (left < np.maximum(HONEST, TOLD_WITHIN * slid)).all()
        if len(slid) >= SEVERAL and speed > DRIFT:
            agree |= np.sqrt(np.mean(left**2)) < TOLD_BY_ALL * np.sqrt(np.mean(slid**2))
        return bool(slid.sum() > LEAST_SLID and agree)


def _drift(slides: _Slides, slowest: float) -> tuple[float, float] | None:
    """M/s, along the floor, that nearly all speeds have, and each stance."""
    middle, differ = agreed(slides.speeds)
    speed = float(np.linalg.norm(middle))
    if speed < slowest or differ > ALIKE * speed or not _is_steady(slides.speeds):
        return None
    if not slides.tell(middle):
        return None
    x, y = map(float, middle)
    return x, y


def find_rise(recording: Recording, figure: Figure) -> Finding | None:
    """Feet that all rise, or sink, at the same speed while they stand: the whole body drifts. Who
    climbs has feet that stand still. recording: in its right size and time."""
    feet = FlatSamples.of(recording, figure)
    if len(feet.times) < LEAST_LEVEL * recording.rate:
        return None
    speeds = feet.velocities[:, 2:]
    (rise,), differ = agreed(speeds)
    if abs(rise) < RISE or differ > ALIKE_RISE * abs(rise) or not _is_steady(speeds):
        return None
    heights = feet.places[:, 2]
    if np.std(heights - rise * feet.times) > LEVELLED * np.std(heights):
        return None
    return Finding(FindingKind.RISING, float(rise), "m/s", remedy=Repairs(rise=float(rise)))


def _is_steady(speeds: FloatArray) -> bool:
    """Whether speeds (N, D), m/s, in their order, are alike in both halves: what floats to and fro
    goes elsewhere in one of them."""
    middle = np.median(speeds, axis=0)
    apart = [np.median(half, axis=0) - middle for half in np.array_split(speeds, 2)]
    return bool(max(np.linalg.norm(apart, axis=1)) < STEADY * np.linalg.norm(middle))


@dataclass(frozen=True)
class LowestPoint:
    """Of the feet, while it stands, N samples: s, m and m/s."""

    times: FloatArray
    places: FloatArray
    velocities: FloatArray


def standing(performance: Performance, high: float = LOW) -> LowestPoint:
    """When, where and how fast the lowest point of the feet stands, near its floor. high: m above
    that."""
    points, floor = contact_points(performance)
    feet = [point.track for point in points.values() if point.kind.is_of_foot]
    tracks = np.stack(feet, axis=1)
    velocity = np.gradient(tracks, performance.times, axis=0)
    lowest = np.argmin(tracks[:, :, 2], axis=1), np.arange(len(tracks))
    place, speed = tracks[lowest[1], lowest[0]], velocity[lowest[1], lowest[0]]
    stands = (place[:, 2] - floor < high) & (np.abs(speed[:, 2]) < STANDING_SPEED_UP)
    return LowestPoint(performance.times[stands], place[stands], speed[stands])


def _flicker(performance: Performance, schedule: ContactSchedule) -> Finding | None:
    """Points that leave their place and come back in less time than a foot can."""
    breaks: list[tuple[Interval, str]] = []
    for point in {contact.point for contact in schedule.contacts}:
        own = [c for c in schedule.contacts if c.point == point]
        for one, other in pairwise(sorted(own, key=lambda c: c.start)):
            same = np.linalg.norm((other.place - one.place)[:2]) < FLICKER_PLACE
            if same and other.start - one.end < MAX_BREAK:
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
