"""Contact detection by height and speed thresholds, and by whether the body falls between."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..data.contacts import (
    Contact,
    ContactPoint,
    ContactSchedule,
    ContactThresholds,
    Interval,
    gaps,
)
from ..numerics.interpolation import interpolate
from ..numerics.runs import runs
from ..scene.carrier import Carrier
from ..scene.support import LEAST_HEIGHT, Heights, level
from ..unseen.free_fall import is_free_fall, off_gravity, unseen_support
from .events import numbered
from .flat_soles import lies_elsewhere, lying
from .force_timing import timed_by_forces
from .noisy_touches import joined_over_noise
from .point_movement import MAX_SLIDE, STEP, PointMovement, even_clock, point_movement

MIN_SEPARATION = 0.03  # s; between two contacts of one point
CREEP_WINDOW = 0.4  # s; of the running median of a resting point's place
HALF_CREEP = round(CREEP_WINDOW / (2.0 * STEP))  # instants
STILL = 0.1  # m/s; slower is a foot that stands
STANDS = round(0.06 / STEP)  # instants, for which it does
REACH = 100  # instants on each side of a rest in which a point mostly leaves its place
SINK_WINDOW = 0.2  # s; of the running low of its height, when it lands
MIN_PIECE = 0.03  # s, of a contact that a cut leaves; a foot takes as long to land or leave
MAX_DELAY = 0.1  # s, by which noise delays a contact of who stands; a hop of 1 cm flies as long
RESTART = 2.0  # times the speed of one that rests: so fast a foot goes on that paused in the air
LEAST_FALL = 0.25  # m/s; a flight of 0.05 s ends, and begins, so fast; standing bodies are slower


def detect_contacts(
    times: FloatArray,
    points: Mapping[str, ContactPoint],
    *,
    floor_m: float = 0.0,
    com: FloatArray | None = None,
    duration_s: float | None = None,
    shortest_flight_s: float = 0.03,
    ground: Heights | None = None,
    carriers: Sequence[Carrier] = (),
) -> ContactSchedule:
    """Contact schedule of a recording.

    times: (T,) s. duration_s: the schedule is of [0, duration_s], None for all times; what is
    recorded before and after tells of the contacts that are cut off. points: by name ("Left heel").
    com: (T, 3) m, the centre of mass: an interval without contact in which it does not fall freely
    is `unseen` support, not a flight. ground: heights of what points are above then, None for the
    floor alone. carriers: ground that moves; places of contacts on it are as seen from it. Gaps
    below shortest_flight_s are closed. A point that is low and slow touches; the contact lasts
    while it stays at its height of that contact, and a foot's as long as its force acts, to a
    fraction of a frame.
    """
    duration = float(times[-1]) if duration_s is None else duration_s
    clock = even_clock(float(times[0]), float(times[-1]))
    movements = {name: point_movement(times, p, clock) for name, p in points.items()}
    touches = list(_touches(clock, points, movements, ground or level(floor_m)))
    feet = {name: movements[name] for name, p in points.items() if p.kind.is_of_foot}
    touches = joined_over_noise(clock, touches, feet, ground or level(floor_m))
    for carrier in carriers:
        touches += _carried(times, clock, points, carrier)
    touches = _on_one_thing(touches) if carriers else touches
    heights = {name: movement.track[:, 2] for name, movement in movements.items()}
    legs = {
        name: np.linalg.norm(movements[name].track - interpolate(times, p.hip, clock), axis=1)
        for name, p in points.items()
        if p.hip is not None
    }
    frame_time = float(np.median(np.diff(times)))
    touches = timed_by_forces(clock, touches, heights, legs, frame_time)
    contacts = _within(touches, duration)
    contacts = _kept_off_ends(contacts, duration, shortest_flight_s, times, com)
    contacts = _closed(contacts, duration, shortest_flight_s, times, com)
    unseen = unseen_support(contacts, duration, times, com)
    return ContactSchedule(numbered(contacts), duration, floor_m, unseen)


def _touches(
    clock: FloatArray,
    points: Mapping[str, ContactPoint],
    movements: Mapping[str, PointMovement],
    ground: Heights,
) -> Iterable[Contact]:
    """Contacts, each point's in order and disjoint. clock: (N,) s, of the movements."""
    above = {name: m.track[:, 2] - ground(clock, m.track) for name, m in movements.items()}
    for name, flat in lying(above).items():
        low = (above[name] < points[name].max_height) | (flat < LEAST_HEIGHT)
        for contact in _touches_of(clock, name, points[name], movements[name], low):
            during = (clock >= contact.start) & (clock <= contact.end)
            if not lies_elsewhere(flat[during]):
                yield contact


def _touches_of(
    clock: FloatArray, name: str, point: ContactPoint, movement: PointMovement, low: BoolArray
) -> Iterable[Contact]:
    """Contacts of one point. low: (N,) whether it is low enough."""
    thresholds = point.kind.value
    at_rest = low & (np.linalg.norm(movement.velocity, axis=1) < thresholds.max_speed)
    candidates = [
        candidate
        for first, last in runs(at_rest)
        for candidate in _candidates_around(clock, thresholds, movement, first, last)
    ]
    for candidate in _joined(_without_pauses(candidates, thresholds, movement), movement):
        cut_off = candidate.start <= clock[0] or candidate.end >= clock[-1]
        rest = (candidate.last - candidate.first) * STEP
        lasts = candidate.end - candidate.start > thresholds.min_duration
        if cut_off or (lasts and rest >= thresholds.min_rest):
            during = slice(candidate.first, candidate.last + 1)
            place = np.median(movement.point[during][at_rest[during]], axis=0)
            yield Contact(
                name, name, point.bone, point.offset, candidate.start, candidate.end, place
            )


def _carried(
    times: FloatArray, clock: FloatArray, points: Mapping[str, ContactPoint], carrier: Carrier
) -> Iterable[Contact]:
    """Contacts with ground that moves: of points that are low and slow as seen from it."""
    seen = {name: carrier.seen_point(times, point) for name, point in points.items()}
    movements = {name: point_movement(times, point, clock) for name, point in seen.items()}
    for contact in _touches(clock, seen, movements, carrier.heights):
        yield replace(contact, on=carrier.name)


def _on_one_thing(contacts: Iterable[Contact]) -> list[Contact]:
    """Of contacts of one point at one time the longest."""
    kept: list[Contact] = []
    for contact in sorted(contacts, key=lambda c: c.start - c.end):
        others = (c for c in kept if c.point == contact.point)
        if all(c.start >= contact.end or c.end <= contact.start for c in others):
            kept.append(contact)
    return kept


@dataclass(frozen=True)
class _Candidate:
    """Candidate contact: start and end, s, and the first and last instant at rest."""

    start: float
    end: float
    first: int
    last: int


def _candidates_around(
    clock: FloatArray, thresholds: ContactThresholds, movement: PointMovement, first: int, last: int
) -> Iterable[_Candidate]:
    """Region growing from a rest to where the point leaves its place; usually one candidate."""
    begin, landing, lifting = _shares_around(thresholds, movement, first, last)
    times = clock[begin : begin + len(landing)]
    for a, b in runs(np.minimum(landing, lifting) <= 1.0):
        inside = slice(a, b + 1)
        stands = (landing[inside] <= 1.0).any() and (lifting[inside] <= 1.0).any()
        if stands and begin + a <= last and begin + b >= first:
            start, end = _first_below(times, landing, a), _last_below(times, lifting, b)
            if end > start:
                yield _Candidate(start, end, max(begin + a, first), min(begin + b, last))


def _shares_around(
    thresholds: ContactThresholds, movement: PointMovement, first: int, last: int
) -> tuple[int, FloatArray, FloatArray]:
    """What `_leaving` tells around a rest, as far as to where the point has left its place, and
    the first instant of that. Looking at all of a take for each rest would cost its square."""
    reach, count = REACH, len(movement.track)
    while True:
        begin, end = max(first - reach, 0), min(last + 1 + reach, count)
        rest = first - begin, last - begin
        landing, lifting = _leaving(thresholds, movement.part(begin, end), rest)
        stays = np.minimum(landing, lifting) <= 1.0
        if (begin == 0 or not stays[0]) and (end == count or not stays[-1]):
            return begin, landing, lifting
        reach *= 2


def _leaving(
    thresholds: ContactThresholds, movement: PointMovement, rest: tuple[int, int]
) -> tuple[FloatArray, FloatArray]:
    """(N,) each: how far a point is from where it rests, of what it may be as it lands, and as it
    lifts. rest: first and last instant."""
    pressing = movement.track[:, 2:]
    above = (pressing - _at_rest(np.fmin.reduce, pressing, SINK_WINDOW, rest))[:, 0]
    place = np.hstack([movement.track[:, :2], movement.point[:, 2:]])
    away = place - _at_rest(_median, place, CREEP_WINDOW, rest)
    along = np.maximum(
        np.linalg.norm(movement.velocity[:, :2], axis=1) / thresholds.max_slip_speed,
        np.linalg.norm(away[:, :2], axis=1) / MAX_SLIDE,
    )
    landing = np.maximum(above / thresholds.landing_height, along)
    return landing, np.maximum(away[:, 2] / thresholds.lift_off_height, along)


def _median(samples: FloatArray, axis: int) -> FloatArray:
    """As `np.nanmedian`, whose masked arrays take ten times as long for windows of a rest."""
    ordered = np.sort(samples, axis=axis)  # NaN comes last
    count = np.sum(~np.isnan(ordered), axis=axis, keepdims=True)
    middle = ((count - 1) // 2, count // 2)
    low, high = (np.take_along_axis(ordered, at, axis).squeeze(axis) for at in middle)
    return np.asarray(0.5 * (low + high))


def _at_rest(
    statistic: Callable[..., FloatArray], samples: FloatArray, window: float, rest: tuple[int, int]
) -> FloatArray:
    """(N, k): a running statistic of samples (N, k) at rest, over `window` s around each.

    Soles sink and feet creep while they stand, and floors are not level: "off the ground" is told
    from where the point stood just then. It is held constant outside the rest.
    """
    first, last = rest
    half = round(window / (2.0 * STEP))
    padded = np.full((last - first + 1 + 2 * half, samples.shape[1]), np.nan)
    padded[half : len(padded) - half] = samples[first : last + 1]
    windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * half + 1, axis=0)
    during = np.clip(np.arange(len(samples)), first, last) - first
    return np.asarray(statistic(windows, axis=-1)[during])


def _first_below(times: FloatArray, excess: FloatArray, frame: int) -> float:
    """First crossing of `excess` (T,) down to 1 from `frame` on, s, linear between frames."""
    below = frame + int(np.argmax(excess[frame:] <= 1.0))
    if below == 0:
        return float(times[0])
    return float(np.interp(-1.0, -excess[below - 1 : below + 1], times[below - 1 : below + 1]))


def _last_below(times: FloatArray, excess: FloatArray, frame: int) -> float:
    """Last crossing of `excess` (T,) up to 1 from `frame` back, s, linear between frames."""
    return -_first_below(-times[::-1], excess[::-1], len(times) - 1 - frame)


def _without_pauses(
    candidates: Sequence[_Candidate], thresholds: ContactThresholds, movement: PointMovement
) -> list[_Candidate]:
    """Candidates but for moments at which a foot that comes down pauses in the air: shorter than
    any contact, just before a rest that is none, higher than from where a foot lands, and left fast
    again, as by none that carries."""
    heights, speeds = movement.track[:, 2], np.linalg.norm(movement.velocity[:, :2], axis=1)
    ordered = sorted(candidates, key=lambda c: c.start)

    def pauses(candidate: _Candidate, following: _Candidate) -> bool:
        lasts = [(each.last - each.first) * STEP for each in (candidate, following)]
        rests = lasts[0] < thresholds.min_duration <= lasts[1]
        if not rests or candidate.end + MIN_SEPARATION < following.start:
            return False
        height = heights[candidate.first] - heights[following.first : following.last + 1].min()
        left = speeds[candidate.last : following.first].max(initial=0.0)
        return bool(height > thresholds.landing_height and left > RESTART * thresholds.max_speed)

    before = [one for one, following in pairwise(ordered) if not pauses(one, following)]
    return before + ordered[-1:]


def _joined(candidates: Iterable[_Candidate], movement: PointMovement) -> list[_Candidate]:
    """Candidates in order, merged where they nearly meet in time at the same place."""
    joined: list[_Candidate] = []
    for candidate in sorted(candidates, key=lambda s: s.start):
        before = joined[-1] if joined else None
        if before is None or candidate.start > before.end + MIN_SEPARATION:
            joined.append(candidate)
            continue
        if _apart(before, candidate, movement) < MAX_SLIDE:
            joined[-1] = replace(
                before,
                end=max(before.end, candidate.end),
                first=min(before.first, candidate.first),
                last=max(before.last, candidate.last),
            )
        else:
            turn = (before.end + candidate.start) / 2
            joined[-1] = replace(before, end=min(before.end, turn))
            joined.append(replace(candidate, start=max(candidate.start, turn)))
    return joined


def _apart(before: _Candidate, after: _Candidate, movement: PointMovement) -> float:
    """M, level, from where a point stands as a rest comes to an end to where it does as the next
    begins, so that a small step is seen; or, of one that creeps and turns under load, and so stands
    not on both sides, between these instants themselves."""
    back = range(before.last, max(before.first, before.last - HALF_CREEP) - 1, -1)
    on = range(after.first, min(after.last, after.first + HALF_CREEP) + 1)
    start, end = _standing_place(movement, back), _standing_place(movement, on)
    if start is None or end is None:
        start, end = movement.track[[before.last, after.first], :2]
    return float(np.linalg.norm(end - start))


def _standing_place(movement: PointMovement, instants: range) -> FloatArray | None:
    """(2,) m, where a point mostly is in the first of some instants in which it is still; None
    where these are too few."""
    places, speeds = movement.track[instants, :2], movement.velocity[instants, :2]
    still = places[np.linalg.norm(speeds, axis=1) < STILL][:STANDS]
    return np.asarray(np.median(still, axis=0)) if len(still) == STANDS else None


def _within(contacts: Iterable[Contact], duration: float) -> list[Contact]:
    """The contacts as far as they are in [0, duration], but for the shortest pieces of cut ones."""
    pieces = []
    for c in contacts:
        piece = replace(c, start=max(c.start, 0.0), end=min(c.end, duration))
        if piece.end - piece.start >= min(c.end - c.start, MIN_PIECE):
            pieces.append(piece)
    return pieces


def _kept_off_ends(
    contacts: Sequence[Contact],
    duration: float,
    shortest: float,
    times: FloatArray,
    com: FloatArray | None,
) -> list[Contact]:
    """The contacts, where the body lands just after the clip's beginning, or leaves just before its
    end, with a flight of `shortest` s there.

    Closed like other short gaps, a foot would stand while it is recorded centimetres up, and fast.
    """
    kept = list(contacts)
    for gap in gaps(((c.start, c.end) for c in contacts), duration):
        first = gap.start == 0.0
        if gap.end - gap.start >= shortest or first == (gap.end == duration):
            continue
        if _stands(times, com, gap):
            continue
        flight = Interval(0.0, shortest) if first else Interval(duration - shortest, duration)
        if not is_free_fall(times, com, flight):
            continue
        if first:
            kept = [replace(c, start=max(c.start, flight.end)) for c in kept]
        else:
            kept = [replace(c, end=min(c.end, flight.start)) for c in kept]
    return [
        now
        for now, was in zip(kept, contacts, strict=True)
        if now.end - now.start >= MIN_PIECE or (now.start, now.end) == (was.start, was.end)
    ]


def _closed(
    contacts: Sequence[Contact],
    duration: float,
    shortest: float,
    times: FloatArray,
    com: FloatArray | None,
) -> list[Contact]:
    """The contacts with every gap shorter than `shortest`, s, and those at the recording's ends in
    which the body stands, closed by those on either side."""
    closed = list(contacts)
    for gap in gaps(((c.start, c.end) for c in contacts), duration):
        if gap.end - gap.start >= shortest - 1e-9 and not _stands(times, com, gap):
            continue
        meet = (gap.start + gap.end) / 2
        if gap.start == 0.0 or gap.end == duration:
            meet = gap.start if gap.start == 0.0 else gap.end
        closed = [replace(c, end=meet) if c.end == gap.start else c for c in closed]
        closed = [replace(c, start=meet) if c.start == gap.end else c for c in closed]
    return closed


def _stands(times: FloatArray, com: FloatArray | None, gap: Interval) -> bool:
    """Whether a gap at an end of the recording is one that noise leaves in the contacts of who
    stands: of a frame or two, which tell no acceleration, and of a body that is slower up and down
    at all of them than one that lands or leaves: about the highest point it comes back."""
    at_end = gap.start <= times[0] or gap.end >= times[-1]
    seconds = gap.end - gap.start
    if com is None or not at_end or seconds > MAX_DELAY:
        return False
    if off_gravity(times, com, gap) is not None:
        return False
    within = times[(times > gap.start) & (times < gap.end)]
    instants = np.concatenate([[gap.start], within, [gap.end]])
    speeds = np.diff(np.interp(instants, times, com[:, 2])) / np.diff(instants)
    return bool(np.abs(speeds).max() < LEAST_FALL)
