"""Finds the contacts in a recording: what touches when, and where."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..data.contacts import Contact, ContactPoint, ContactSchedule, Flight, gaps, numbered
from ..data.faults import NoFlight

BoolArray = NDArray[np.bool_]

CLOSE_GAP = 0.03  # s; a point does not come back sooner
SLIDE = 0.06  # m; a point that slides further stands in a new place
CREEP_TIME = 0.2  # s; a standing point's place is a median over so long before and after
LONGEST_FLIGHT = 1.2  # s; a rise of 1.8 m
SHORTEST_LOOK = 0.05  # s; what it takes to see a fall
GRAVITY = 9.81  # m/s²
FALL_TOLERANCE = 6.0  # m/s²; short flights, and the ends of clips, are that uncertain


def detect_contacts(
    times: FloatArray,
    points: Mapping[str, ContactPoint],
    *,
    floor_m: float = 0.0,
    com: FloatArray | None = None,
    shortest_flight_s: float = 0.03,
) -> ContactSchedule:
    """The contacts of a recording.

    times: (T,) s, from 0. points: by name ("Left heel"). com: (T, 3) m, the centre of mass: an
    interval without contact in which it does not fall freely is `unseen` support, not a flight.
    Gaps below shortest_flight_s are closed. A point that is low and slow touches; the contact
    lasts while it stays at its height of that contact, to a fraction of a frame.
    """
    duration = float(times[-1])
    touches = [t for name, point in points.items() for t in _touches(times, name, point, floor_m)]
    contacts = _closed(touches, duration, shortest_flight_s)
    carried = ((c.start, c.end) for c in contacts)
    unseen = tuple(gap for gap in gaps(carried, duration) if not _falls(times, com, gap))
    return ContactSchedule(numbered(contacts), duration, floor_m, unseen)


def require_flight(schedule: ContactSchedule, points: Mapping[str, ContactPoint]) -> None:
    """Raises NoFlight, with the highest that the lowest point ever is, where nothing flies."""
    if not schedule.flights:
        lowest = np.min([point.track[:, 2] for point in points.values()], axis=0)
        raise NoFlight(lowest_cm=max(100.0 * float(lowest.max() - schedule.floor_m), 0.0))


def _touches(
    times: FloatArray, name: str, point: ContactPoint, floor_m: float
) -> Iterable[Contact]:
    """The contacts of one point, in order and apart from each other."""
    habit = point.kind.value
    velocity = np.gradient(point.track, times, axis=0)
    low = point.track[:, 2] < floor_m + habit.low
    at_rest = low & (np.linalg.norm(velocity, axis=1) < habit.slow)
    stays = [
        stay
        for first, last in _runs(at_rest)
        for stay in _stays_around(times, point, velocity, first, last)
    ]
    for stay in _joined(stays, point.track):
        cut_off = stay.start <= times[0] or stay.end >= times[-1]
        if stay.end - stay.start > (0.0 if cut_off else habit.shortest):
            during = slice(stay.first, stay.last + 1)
            place = np.median(point.track[during][at_rest[during]], axis=0)
            yield Contact(name, name, point.bone, point.offset, stay.start, stay.end, place)


@dataclass(frozen=True)
class _Stay:
    """A contact in the making: s, and the first and last frame at rest."""

    start: float
    end: float
    first: int
    last: int


def _stays_around(
    times: FloatArray, point: ContactPoint, velocity: FloatArray, first: int, last: int
) -> Iterable[_Stay]:
    """A rest, grown to where the point leaves the place it has there; usually one stay."""
    habit = point.kind.value
    away = point.track - _own_place(times, point.track, first, last)
    along = np.maximum(
        np.linalg.norm(velocity[:, :2], axis=1) / habit.skid,
        np.linalg.norm(away[:, :2], axis=1) / SLIDE,
    )
    reach = away[:, 2] + habit.lead * np.minimum(velocity[:, 2], 0.0)
    landing = np.maximum(reach / habit.landed, along)
    lifting = np.maximum(away[:, 2] / habit.lifted, along)
    for a, b in _runs(np.minimum(landing, lifting) <= 1.0):
        if a <= last and b >= first:
            start, end = _first_below(times, landing, a), _last_below(times, lifting, b)
            if end > start:
                yield _Stay(start, end, max(a, first), min(b, last))


def _own_place(times: FloatArray, track: FloatArray, first: int, last: int) -> FloatArray:
    """(T, 3) m: where the point rests, a running median over the rest that is held outside it.

    Feet creep while they stand, and floors are not level: "off the ground" is told from here.
    """
    half = max(1, round(CREEP_TIME / float(np.median(np.diff(times)))))
    padded = np.pad(track[first : last + 1], ((half, half), (0, 0)), constant_values=np.nan)
    windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * half + 1, axis=0)
    own = np.nanmedian(windows, axis=-1)
    return np.asarray(own[np.clip(np.arange(len(track)), first, last) - first])


def _first_below(times: FloatArray, excess: FloatArray, frame: int) -> float:
    """When `excess` first falls to 1, searched from `frame` on, s, between frames too."""
    below = frame + int(np.argmax(excess[frame:] <= 1.0))
    if below == 0:
        return float(times[0])
    return float(np.interp(-1.0, -excess[below - 1 : below + 1], times[below - 1 : below + 1]))


def _last_below(times: FloatArray, excess: FloatArray, frame: int) -> float:
    """When `excess` last rises to 1, searched from `frame` back, s, between frames too."""
    return -_first_below(-times[::-1], excess[::-1], len(times) - 1 - frame)


def _runs(mask: BoolArray) -> list[tuple[int, int]]:
    """First and last index of every stretch of True."""
    edges = np.diff(np.concatenate(([0], mask.astype(np.int8), [0])))
    first, last = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1) - 1
    return list(zip(first.tolist(), last.tolist(), strict=True))


def _joined(stays: Iterable[_Stay], track: FloatArray) -> list[_Stay]:
    """The stays in order, those made one that meet, or nearly, in the same place."""
    joined: list[_Stay] = []
    for stay in sorted(stays, key=lambda s: s.start):
        before = joined[-1] if joined else None
        if before is None or stay.start > before.end + CLOSE_GAP:
            joined.append(stay)
        elif np.linalg.norm((track[stay.first] - track[before.last])[:2]) < SLIDE:
            end, last = max(before.end, stay.end), max(before.last, stay.last)
            joined[-1] = replace(before, end=end, last=last)
        else:
            turn = (before.end + stay.start) / 2
            joined[-1] = replace(before, end=min(before.end, turn))
            joined.append(replace(stay, start=max(stay.start, turn)))
    return joined


def _closed(contacts: Sequence[Contact], duration: float, shortest: float) -> list[Contact]:
    """The contacts with every gap shorter than `shortest` closed by those on either side."""
    closed = list(contacts)
    for gap in gaps(((c.start, c.end) for c in contacts), duration):
        if gap.end - gap.start >= shortest:
            continue
        meet = (gap.start + gap.end) / 2
        if gap.start == 0.0 or gap.end == duration:
            meet = gap.start if gap.start == 0.0 else gap.end
        closed = [replace(c, end=meet) if c.end == gap.start else c for c in closed]
        closed = [replace(c, start=meet) if c.start == gap.end else c for c in closed]
    return closed


def _falls(times: FloatArray, com: FloatArray | None, gap: Flight) -> bool:
    """Whether the body can be in free fall during `gap`."""
    if com is None:
        return gap.end - gap.start < LONGEST_FLIGHT
    middle, half = (gap.start + gap.end) / 2, max(gap.end - gap.start, SHORTEST_LOOK) / 2
    within = np.abs(times - middle) <= half
    if within.sum() < 4:
        return True
    t = times[within] - middle
    curvature = 2.0 * np.polyfit(t, com[within, 2], 2)[0]
    return bool(-GRAVITY - FALL_TOLERANCE < curvature < -GRAVITY + FALL_TOLERANCE)
