"""Contact detection by height and speed thresholds; free-fall check of the gaps between."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..data.constants import STANDARD_GRAVITY
from ..data.contacts import Contact, ContactPoint, ContactSchedule, Interval, gaps, numbered
from ..data.faults import NoFlight

MIN_SEPARATION = 0.03  # s; between two contacts of one point
MAX_SLIDE = 0.06  # m; a point that slides further makes a new contact
MEDIAN_HALF_WINDOW = 0.2  # s; of the running median of a resting point's place
MAX_FLIGHT = 1.2  # s; a rise of 1.8 m
MIN_FALL_WINDOW = 0.05  # s; over which an acceleration can be estimated
FREE_FALL_TOLERANCE = 6.0  # m/s²; short flights, and the ends of clips, are that uncertain


def detect_contacts(
    times: FloatArray,
    points: Mapping[str, ContactPoint],
    *,
    floor_m: float = 0.0,
    com: FloatArray | None = None,
    shortest_flight_s: float = 0.03,
) -> ContactSchedule:
    """Contact schedule of a recording.

    times: (T,) s, from 0. points: by name ("Left heel"). com: (T, 3) m, the centre of mass: an
    interval without contact in which it does not fall freely is `unseen` support, not a flight.
    Gaps below shortest_flight_s are closed. A point that is low and slow touches; the contact
    lasts while it candidates at its height of that contact, to a fraction of a frame.
    """
    duration = float(times[-1])
    touches = [t for name, point in points.items() for t in _touches(times, name, point, floor_m)]
    contacts = _closed(touches, duration, shortest_flight_s)
    carried = ((c.start, c.end) for c in contacts)
    unseen = tuple(gap for gap in gaps(carried, duration) if not _falls(times, com, gap))
    return ContactSchedule(numbered(contacts), duration, floor_m, unseen)


def require_flight(schedule: ContactSchedule, points: Mapping[str, ContactPoint]) -> None:
    """Raises NoFlight, with the largest ground clearance, if the schedule has no flight."""
    if not schedule.flights:
        lowest = np.min([point.track[:, 2] for point in points.values()], axis=0)
        raise NoFlight(lowest_cm=max(100.0 * float(lowest.max() - schedule.floor_m), 0.0))


def _touches(
    times: FloatArray, name: str, point: ContactPoint, floor_m: float
) -> Iterable[Contact]:
    """Contacts of one point, in order and disjoint."""
    thresholds = point.kind.value
    velocity = np.gradient(point.track, times, axis=0)
    low = point.track[:, 2] < floor_m + thresholds.max_height
    at_rest = low & (np.linalg.norm(velocity, axis=1) < thresholds.max_speed)
    candidates = [
        candidate
        for first, last in _runs(at_rest)
        for candidate in _candidates_around(times, point, velocity, first, last)
    ]
    for candidate in _joined(candidates, point.track):
        cut_off = candidate.start <= times[0] or candidate.end >= times[-1]
        if candidate.end - candidate.start > (0.0 if cut_off else thresholds.min_duration):
            during = slice(candidate.first, candidate.last + 1)
            place = np.median(point.track[during][at_rest[during]], axis=0)
            yield Contact(
                name, name, point.bone, point.offset, candidate.start, candidate.end, place
            )


@dataclass(frozen=True)
class _Candidate:
    """Candidate contact: start and end, s, and the first and last frame at rest."""

    start: float
    end: float
    first: int
    last: int


def _candidates_around(
    times: FloatArray, point: ContactPoint, velocity: FloatArray, first: int, last: int
) -> Iterable[_Candidate]:
    """Region growing from a rest to where the point leaves its place; usually one candidate."""
    thresholds = point.kind.value
    away = point.track - _resting_place(times, point.track, first, last)
    along = np.maximum(
        np.linalg.norm(velocity[:, :2], axis=1) / thresholds.max_slip_speed,
        np.linalg.norm(away[:, :2], axis=1) / MAX_SLIDE,
    )
    reach = away[:, 2] + thresholds.lead_time * np.minimum(velocity[:, 2], 0.0)
    landing = np.maximum(reach / thresholds.landing_height, along)
    lifting = np.maximum(away[:, 2] / thresholds.lift_off_height, along)
    for a, b in _runs(np.minimum(landing, lifting) <= 1.0):
        if a <= last and b >= first:
            start, end = _first_below(times, landing, a), _last_below(times, lifting, b)
            if end > start:
                yield _Candidate(start, end, max(a, first), min(b, last))


def _resting_place(times: FloatArray, track: FloatArray, first: int, last: int) -> FloatArray:
    """(T, 3) m: running median of the track over the rest, held constant outside it.

    Feet creep while they stand, and floors are not level: "off the ground" is told from here.
    """
    half = max(1, round(MEDIAN_HALF_WINDOW / float(np.median(np.diff(times)))))
    padded = np.pad(track[first : last + 1], ((half, half), (0, 0)), constant_values=np.nan)
    windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * half + 1, axis=0)
    own = np.nanmedian(windows, axis=-1)
    return np.asarray(own[np.clip(np.arange(len(track)), first, last) - first])


def _first_below(times: FloatArray, excess: FloatArray, frame: int) -> float:
    """First crossing of `excess` (T,) down to 1 from `frame` on, s, linear between frames."""
    below = frame + int(np.argmax(excess[frame:] <= 1.0))
    if below == 0:
        return float(times[0])
    return float(np.interp(-1.0, -excess[below - 1 : below + 1], times[below - 1 : below + 1]))


def _last_below(times: FloatArray, excess: FloatArray, frame: int) -> float:
    """Last crossing of `excess` (T,) up to 1 from `frame` back, s, linear between frames."""
    return -_first_below(-times[::-1], excess[::-1], len(times) - 1 - frame)


def _runs(mask: BoolArray) -> list[tuple[int, int]]:
    """First and last index of every run of True in (T,)."""
    edges = np.diff(np.concatenate(([0], mask.astype(np.int8), [0])))
    first, last = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1) - 1
    return list(zip(first.tolist(), last.tolist(), strict=True))


def _joined(candidates: Iterable[_Candidate], track: FloatArray) -> list[_Candidate]:
    """Candidates in order, merged where they nearly meet in time at the same place."""
    joined: list[_Candidate] = []
    for candidate in sorted(candidates, key=lambda s: s.start):
        before = joined[-1] if joined else None
        if before is None or candidate.start > before.end + MIN_SEPARATION:
            joined.append(candidate)
        elif np.linalg.norm((track[candidate.first] - track[before.last])[:2]) < MAX_SLIDE:
            end, last = max(before.end, candidate.end), max(before.last, candidate.last)
            joined[-1] = replace(before, end=end, last=last)
        else:
            turn = (before.end + candidate.start) / 2
            joined[-1] = replace(before, end=min(before.end, turn))
            joined.append(replace(candidate, start=max(candidate.start, turn)))
    return joined


def _closed(contacts: Sequence[Contact], duration: float, shortest: float) -> list[Contact]:
    """The contacts with every gap shorter than `shortest`, s, closed by those on either side."""
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


def _falls(times: FloatArray, com: FloatArray | None, gap: Interval) -> bool:
    """Whether the body can be in free fall during `gap`: curvature of a fitted parabola."""
    if com is None:
        return gap.end - gap.start < MAX_FLIGHT
    middle, half = (gap.start + gap.end) / 2, max(gap.end - gap.start, MIN_FALL_WINDOW) / 2
    within = np.abs(times - middle) <= half
    if within.sum() < 4:
        return True
    t = times[within] - middle
    curvature = 2.0 * np.polyfit(t, com[within, 2], 2)[0]
    return bool(
        -STANDARD_GRAVITY - FREE_FALL_TOLERANCE
        < curvature
        < -STANDARD_GRAVITY + FREE_FALL_TOLERANCE
    )
