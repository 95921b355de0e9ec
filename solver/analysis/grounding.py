"""Grounding: contacts as feet can keep them, on the floor and with time to step between places.

Soles and floors give by millimetres, and a recording's skeleton does not know them. A place near
the floor is put upon it; at a landing and a lift-off the point may be as high above its place as a
sole gives, and as the recording shows it. A foot that slides is at one place and then at the next;
in between it is not loaded.
"""

from collections.abc import Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np

from ..arrays import FloatArray
from ..data.contacts import Contact, ContactSchedule
from ..data.scene import SceneObject
from ..numerics.interpolation import interpolate
from ..scene.support import StandingGround
from .performance import Performance

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
# m, by which heel and toe of a foot without toes are unlike in height as one of them sinks or
# rises: tilted by 8 mm it is 0.15 mm shorter along the floor, where neither may slide.
MAX_TILT = 0.002
MAX_STEP_SHARE = 0.3  # of the shorter of two contacts that a step takes from each


def parted(schedule: ContactSchedule) -> ContactSchedule:
    """The schedule with time for each foot to step between places that follow each other.

    Places nearer than SAME_PLACE are one, and the times stay: nothing has to step. Nor does a foot
    where nothing else would carry the body meanwhile.
    """
    found = schedule
    for i, before in enumerate(schedule.contacts):
        for j, after in enumerate(schedule.contacts):
            gap = after.start - before.end
            if after.point != before.point or i == j or not -1e-9 < gap < MIN_STEP_TIME:
                continue
            contacts = list(found.contacts)
            apart = float(np.linalg.norm(after.place - before.place))
            if apart <= SAME_PLACE:
                contacts[j] = replace(contacts[j], place=contacts[i].place)
            else:
                shorter = min(before.end - before.start, after.end - after.start)
                needed = max(MIN_STEP_TIME, apart / MAX_STEP_SPEED)
                each = min(0.5 * (needed - gap), MAX_STEP_SHARE * shorter)
                contacts[i] = replace(contacts[i], end=before.end - each)
                contacts[j] = replace(contacts[j], start=after.start + each)
            stepping = replace(found, contacts=tuple(contacts))
            found = stepping if stepping.phases == schedule.phases else found
    return found


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
    """The schedule with its places near the ground put upon it, and each contact's rise; places on
    ground that moves are where they are when the stance begins.

    scene: the objects that contacts may be on.
    """
    ground = StandingGround.of(schedule.floor_m, scene, performance.recording)
    contacts = [_grounded(c, schedule, performance, ground) for c in schedule.contacts]
    level = tuple(replace(c, rise=_level_rise(c, contacts)) for c in contacts)
    return ground.placed(replace(schedule, contacts=level))


def _grounded(
    contact: Contact, schedule: ContactSchedule, performance: Performance, ground: StandingGround
) -> Contact:
    ground_m = ground.beneath(contact)
    height = float(contact.place[2]) - ground_m
    if abs(height) < NEAR_FLOOR:
        height = float(np.clip(height, *PLACE_BAND))
    place = np.array([*contact.place[:2], ground_m + height])
    track = _track(contact, performance, ground)
    ends = np.array([contact.start, contact.end])
    above = interpolate(performance.times, track[:, 2], ends) - place[2]
    cut_off = (ends <= 0.0) | (ends >= schedule.duration)
    first, last = np.where(cut_off, 0.0, np.clip(above, 0.0, SOLE_COMPLIANCE)).tolist()
    return replace(contact, place=place, rise=(first, last))


def _level_rise(contact: Contact, contacts: Sequence[Contact]) -> tuple[float, float]:
    """A contact's rise, no further from that of what stands on the same bone than it may tilt."""
    first, last = contact.rise
    for other in contacts:
        if other.bone == contact.bone and other.point != contact.point:
            first = min(first, _height_at(contact.start, other) + MAX_TILT)
            last = min(last, _height_at(contact.end, other) + MAX_TILT)
    return first, last


def _height_at(time: float, contact: Contact) -> float:
    """M, of a contact's point above its place, where within it has sunk, which takes moments;
    infinite where it does not touch."""
    if not contact.start <= time <= contact.end:
        return np.inf
    if time == contact.start:
        return contact.rise[0]
    return contact.rise[1] if time == contact.end else 0.0
