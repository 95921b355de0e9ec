"""Grounding: contacts as feet can keep them, on the floor and with time to step between places.

Soles and floors give by millimetres, and a recording's skeleton does not know them. A sole's place
near the floor is put upon it; at a landing and a lift-off the point may be as high above its place
as a sole gives, and as the recording shows it. A foot that slides is at one place and then at the
next; in between it is not loaded.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from ..arrays import FloatArray
from ..data.contacts import Contact, ContactSchedule, Interval
from ..data.scene import SceneObject
from ..numerics.interpolation import interpolate
from ..scene.support import StandingGround
from .performance import Performance, contact_points

NEAR_FLOOR = 0.04  # m; a place further away is on something else
PLACE_BAND = (-0.002, 0.0015)  # m about the floor's height, where places are
# m; as much as a heel pad gives in running: 9.0 mm barefoot, 5.5 in a shoe, whose midsole gives too
# (De Clercq, Aerts and Kunnen, Journal of Biomechanics 27, 1994).
SOLE_COMPLIANCE = 0.008
SAME_PLACE = 0.01  # m; a recording tells where a foot stands no better, and its sole rolls as far
MAX_STEP_SPEED = 1.0  # m/s; of a foot that is shifted from place to place
MIN_STEP_TIME = 0.06  # s
MAX_FOOT_CHANGE = 0.02  # m; by as much a foot's heel and toe come nearer as it bends and rolls
MIN_OVERLAP = 0.01  # s; in which heel and toe stand together
OVERLAP_SAMPLES = 9
# m, by which a foot without toes may be tilted as one of heel and toe sinks or rises beside the
# other that stands: by 8 mm it would be 0.15 mm shorter along the floor, where neither may slide.
MAX_TILT = 0.002
MAX_STEP_SHARE = 0.3  # of a contact that a step takes from it
RIGID_ROUNDS, RIGID = 100, 1e-5  # of settling places, and m by which they then may differ


def parted(schedule: ContactSchedule) -> ContactSchedule:
    """The schedule with time for each foot to step between places that follow each other.

    Places nearer than SAME_PLACE are one, and the times stay: nothing has to step. Where nothing
    else carries the body meanwhile the foot skids, and something unseen carries: phases stay.
    """
    found = schedule
    for i, before in enumerate(schedule.contacts):
        for j, after in enumerate(schedule.contacts):
            meet = -1e-9 < after.start - before.end < MIN_STEP_TIME
            alike = (after.point, after.on) == (before.point, before.on)
            if meet and alike and i != j:
                found = _stepping(found, i, j)
    return found


def _stepping(schedule: ContactSchedule, i: int, j: int) -> ContactSchedule:
    """The schedule with time for a point to go from contact i to contact j, or with one place."""
    before, after = schedule.contacts[i], schedule.contacts[j]
    apart = float(np.linalg.norm(after.place - before.place))
    if apart <= SAME_PLACE:
        return _changed(schedule, {j: replace(after, place=before.place)})
    needed = max(MIN_STEP_TIME, apart / MAX_STEP_SPEED)
    for share in (0.5, 0.0, 1.0):
        stepping = _apart_by(schedule, i, j, needed, share)
        if stepping.phases == schedule.phases:
            return stepping
    if after.start - before.end > 1e-9:
        return schedule  # what is between has been found to be a flight, or to be carried
    skidding = _apart_by(schedule, i, j, needed)
    skid = Interval(skidding.contacts[i].end, skidding.contacts[j].start)
    return replace(skidding, unseen=(*schedule.unseen, skid))


def _apart_by(
    schedule: ContactSchedule, i: int, j: int, needed: float, share: float = 0.5
) -> ContactSchedule:
    """The schedule with `needed` s between contacts i and j, or what they can give.

    share: of that time from contact i, the rest from j.
    """
    before, after = schedule.contacts[i], schedule.contacts[j]
    missing = needed - (after.start - before.end)
    for part, each in ((share, before), (1.0 - share, after)):
        if part > 0.0:
            missing = min(missing, MAX_STEP_SHARE * (each.end - each.start) / part)
    ends = {
        i: replace(before, end=before.end - share * missing),
        j: replace(after, start=after.start + (1.0 - share) * missing),
    }
    return _changed(schedule, ends)


def _changed(schedule: ContactSchedule, changed: Mapping[int, Contact]) -> ContactSchedule:
    contacts = tuple(changed.get(k, c) for k, c in enumerate(schedule.contacts))
    return replace(schedule, contacts=contacts)


def disjoint(schedule: ContactSchedule) -> ContactSchedule:
    """The schedule with each point in one place at a time, whatever was added to what was found.

    Contacts of a point that overlap are one where they are at the same place; else the overlap is
    shared out between them.
    """
    kept: list[Contact] = []
    for contact in sorted(schedule.contacts, key=lambda c: (c.start, c.point)):
        last = next((k for k, c in enumerate(kept) if _overlap(c, contact)), None)
        if last is None:
            kept.append(contact)
            continue
        before = kept[last]
        if float(np.linalg.norm(contact.place - before.place)) <= SAME_PLACE:
            kept[last] = replace(before, end=max(before.end, contact.end))
        elif contact.end > before.end:
            turn = 0.5 * (contact.start + before.end)
            kept[last] = replace(before, end=turn)
            kept.append(replace(contact, start=turn))
    return replace(schedule, contacts=tuple(sorted(kept, key=lambda c: (c.start, c.point))))


@dataclass(frozen=True)
class Stray:
    """How far, m, and when, s, a contact's point is from its place at most, while it lasts."""

    contact: Contact
    away: float
    when: float


def strays(schedule: ContactSchedule, performance: Performance) -> Iterator[Stray]:
    """Of each contact on the floor, in the recording."""
    points, times = contact_points(performance)[0], performance.times
    for contact in (each for each in schedule.contacts if each.on is None):
        lasts = np.flatnonzero((times >= contact.start) & (times <= contact.end))
        if len(lasts):
            away = np.linalg.norm(points[contact.point].track[lasts] - contact.place, axis=1)
            worst = int(np.argmax(away))
            yield Stray(contact, float(away[worst]), float(times[lasts[worst]]))


def _overlap(before: Contact, after: Contact) -> bool:
    return before.point == after.point and before.end > after.start + 1e-9


def foot_sized(
    schedule: ContactSchedule, performance: Performance, scene: Sequence[SceneObject] = ()
) -> ContactSchedule:
    """The schedule with heel and toe of a foot as far apart as the foot is long.

    A foot that turns while it stands leaves its heel and toe places of different moments. The point
    that stands for longer keeps its place, or takes along what stands for less than it.
    """
    ground = StandingGround.of(schedule.floor_m, scene, performance.recording)
    contacts = list(schedule.contacts)
    longest_first = sorted(range(len(contacts)), key=lambda k: contacts[k].start - contacts[k].end)
    for longer, shorter in combinations(longest_first, 2):
        apart = _recorded_apart(contacts[shorter], contacts[longer], performance, ground)
        if apart is None:
            continue
        found = (contacts[shorter].place - contacts[longer].place)[:2]
        if abs(np.linalg.norm(found) - np.linalg.norm(apart)) > MAX_FOOT_CHANGE:
            level = contacts[longer].place[:2] + apart
            place = np.array([*level, contacts[shorter].place[2]])
            contacts[shorter] = replace(contacts[shorter], place=place)
    return replace(schedule, contacts=tuple(contacts))


def _recorded_apart(
    one: Contact, other: Contact, performance: Performance, ground: StandingGround
) -> FloatArray | None:
    """(2,) m, level, from the other point to this one while both stand; None if not of one foot."""
    start, end = max(one.start, other.start), min(one.end, other.end)
    feet = [c.point.rpartition(" ") for c in (one, other)]
    if feet[0][0] != feet[1][0] or {f[2] for f in feet} != {"heel", "toe"}:
        return None
    if end - start < MIN_OVERLAP:
        return None
    between = _track(one, performance, ground) - _track(other, performance, ground)
    instants = np.linspace(start, end, OVERLAP_SAMPLES)
    return np.asarray(np.median(interpolate(performance.times, between, instants)[:, :2], axis=0))


def _track(contact: Contact, performance: Performance, ground: StandingGround) -> FloatArray:
    """(T, 3) m, the contact's point as it was recorded, seen from what carries it."""
    recording = performance.recording
    bone = recording.index(contact.bone)
    track = np.asarray(recording.heads[:, bone] + recording.rotations[:, bone] @ contact.offset)
    carrier = ground.carrier(contact)
    return track if carrier is None else carrier.seen(recording.times, track)


def grounded(
    schedule: ContactSchedule, performance: Performance, scene: Sequence[SceneObject] = ()
) -> ContactSchedule:
    """The schedule with its places near the ground put upon it, those of one bone as far apart as
    it has them, and each contact's rise; places on ground that moves are where they are when the
    stance begins.

    scene: the objects that contacts may be on.
    """
    ground = StandingGround.of(schedule.floor_m, scene, performance.recording)
    contacts = [_grounded(c, schedule, performance, ground) for c in schedule.contacts]
    level = tuple(replace(c, rise=_level_rise(c, contacts)) for c in contacts)
    return ground.placed(rigid(replace(schedule, contacts=level)))


def _grounded(
    contact: Contact, schedule: ContactSchedule, performance: Performance, ground: StandingGround
) -> Contact:
    ground_m = ground.beneath(contact)
    height = float(contact.place[2]) - ground_m
    if abs(height) < NEAR_FLOOR:
        low, high = PLACE_BAND
        # The point of a hand or a knee is within its flesh, which keeps it off the floor.
        height = float(np.clip(height, low, high if contact.touch.is_of_foot else NEAR_FLOOR))
    place = np.array([*contact.place[:2], ground_m + height])
    track = _track(contact, performance, ground)
    ends = np.array([contact.start, contact.end])
    above = interpolate(performance.times, track[:, 2], ends) - place[2]
    cut_off = (ends <= 0.0) | (ends >= schedule.duration)
    first, last = np.where(cut_off, 0.0, np.clip(above, 0.0, SOLE_COMPLIANCE)).tolist()
    return replace(contact, place=place, rise=(first, last))


def _level_rise(contact: Contact, contacts: Sequence[Contact]) -> tuple[float, float]:
    """A contact's rise, no further from that of what stands on the same bone than it may tilt, and
    the same where both land or leave."""
    first, last = contact.rise
    for other in contacts:
        if other.bone == contact.bone and other.point != contact.point:
            first = min(first, _height_at(contact.start, other))
            last = min(last, _height_at(contact.end, other))
    return first, last


def _height_at(time: float, contact: Contact) -> float:
    """M, above its place, to which a contact's point lets another of its bone rise; infinite where
    it does not touch."""
    at_start, at_end = (abs(time - end) < 1e-9 for end in (contact.start, contact.end))
    if at_start or at_end:
        return contact.rise[0 if at_start else 1]
    return MAX_TILT if contact.start < time < contact.end else np.inf


def rigid(schedule: ContactSchedule) -> ContactSchedule:
    """The schedule with places of points that one bone holds at one instant as far apart along the
    floor as they are on the bone.

    Heel and toe of a foot without toes are such points, found at different moments of its turning.
    Each pair is settled in turn, and the one that stands for less gives way more (Gauss-Seidel).
    """
    contacts = schedule.contacts
    held = [
        (i, j, distance)
        for (i, a), (j, b) in combinations(enumerate(contacts), 2)
        if (a.bone, a.on) == (b.bone, b.on)
        and a.point != b.point
        and min(a.end, b.end) - max(a.start, b.start) > -1e-9
        and (distance := _level_distance(a, b)) > 0.0
    ]
    if not held:
        return schedule
    places = np.array([c.place for c in contacts])
    lasts = [c.end - c.start for c in contacts]
    for _ in range(RIGID_ROUNDS):
        worst = 0.0
        for i, j, distance in held:
            between = (places[j] - places[i])[:2]
            norm = max(float(np.linalg.norm(between)), RIGID)
            step = (norm - distance) / norm * between / (lasts[i] + lasts[j])
            places[i, :2] += lasts[j] * step
            places[j, :2] -= lasts[i] * step
            worst = max(worst, abs(norm - distance))
        if worst < RIGID:
            break
    moved = zip(contacts, places, strict=True)
    return replace(schedule, contacts=tuple(replace(c, place=place) for c, place in moved))


def _level_distance(one: Contact, other: Contact) -> float:
    """M, along the floor, between points of one bone at the heights of their places; 0 where these
    differ by more than the points are apart."""
    apart = float(np.linalg.norm(one.offset - other.offset))
    up = float(one.place[2] - other.place[2])
    return float(np.sqrt(max(apart**2 - up**2, 0.0)))
