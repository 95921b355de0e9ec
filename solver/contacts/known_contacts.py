"""Contacts that are known because an adaptation made them, and so need not be found.

Found anew they would be longer, adaptation by adaptation, until no flight is left: a foot that was
recorded hits the floor, and is pulled off it, but a solved one comes to rest and leaves as gently
as the laws of motion let it.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import FloatArray
from ..data.contacts import Contact, ContactPoint, Interval, KnownContacts, gaps

MAX_STRAY = 0.03  # m, from its place; a sole rises by less before its force ends
MAX_LONGER = 0.1  # s, by which a solved contact is found too long at an end; 0.07 on a run
ROUNDING = 1e-6  # s


@dataclass(frozen=True)
class Clock:
    """Scene frames (T,) of a take, and their times (T,) s."""

    frames: FloatArray
    times: FloatArray

    def seconds(self, frame: float) -> float:
        return float(np.interp(frame, self.frames, self.times))

    def during(self, start: float, end: float) -> slice:
        """The frames from one instant to another, s; one where none is between."""
        first, last = np.searchsorted(self.times, [start - ROUNDING, end + ROUNDING]).tolist()
        first = min(first, len(self.times) - 1)
        return slice(first, max(last, first + 1))


def with_known(
    found: Iterable[Contact],
    known: Iterable[KnownContacts],
    clock: Clock,
    points: Mapping[str, ContactPoint],
    duration: float,
) -> list[Contact]:
    """The contacts found, but in frames in which all are known these.

    points: by name, with tracks by the clock. duration: s, from 0, of what is looked at. Frames
    that were changed since, so that this is not so any more, are as they were found.
    """
    contacts = list(found)
    for each in known:
        first, last = clock.seconds(each.first), clock.seconds(each.last)
        within = Interval(max(first, 0.0), min(last, duration))
        told = list(_of_points(each, clock, points))
        if within.start < within.end and _holds(told, contacts, within, clock, points):
            contacts = _spliced(contacts, told, within)
    return contacts


def _holds(
    told: Sequence[Contact],
    found: Iterable[Contact],
    within: Interval,
    clock: Clock,
    points: Mapping[str, ContactPoint],
) -> bool:
    """Whether what is told of an interval is still so: its points keep their places, and none of
    them touches for longer at once than thresholds err by while it is told to be up."""
    if not all(_stays(contact, clock, points) for contact in told):
        return False
    for contact in (_cut(each, within.start, within.end) for each in found):
        own = [_cut(c, contact.start, contact.end) for c in told if c.point == contact.point]
        touched = ((c.start - contact.start, c.end - contact.start) for c in own)
        up = gaps((t for t in touched if t[0] < t[1]), contact.end - contact.start)
        if any(gap.end - gap.start > MAX_LONGER for gap in up):
            return False
    return True


def _of_points(
    known: KnownContacts, clock: Clock, points: Mapping[str, ContactPoint]
) -> Iterator[Contact]:
    """The known contacts of these points, each where its point mostly is meanwhile."""
    for name, first, last in known.contacts:
        point, start, end = points.get(name), clock.seconds(first), clock.seconds(last)
        if point is not None and start < end:
            place = np.median(point.track[clock.during(start, end)], axis=0)
            yield Contact(name, name, point.bone, point.offset, start, end, place)


def _stays(contact: Contact, clock: Clock, points: Mapping[str, ContactPoint]) -> bool:
    """Whether a contact's point keeps its place as long as it touches."""
    track = points[contact.point].track[clock.during(contact.start, contact.end)]
    return bool(np.linalg.norm(track - contact.place, axis=1).max() < MAX_STRAY)


def _spliced(found: Iterable[Contact], known: Iterable[Contact], within: Interval) -> list[Contact]:
    """Known contacts in an interval, and what it leaves of those found; what meets is one."""
    pieces = [_cut(c, within.start, within.end) for c in known]
    pieces += [_cut(c, -np.inf, within.start) for c in found]
    pieces += [_cut(c, within.end, np.inf) for c in found]
    joined: dict[str, list[Contact]] = {}
    for piece in sorted((p for p in pieces if p.start < p.end), key=lambda c: c.start):
        before = joined.setdefault(piece.point, [])
        if not before or piece.start > before[-1].end + ROUNDING:
            before.append(piece)
        else:
            longer = max(before[-1], piece, key=lambda c: c.end - c.start)
            end = max(before[-1].end, piece.end)
            before[-1] = replace(longer, start=before[-1].start, end=end)
    return [contact for contacts in joined.values() for contact in contacts]


def _cut(contact: Contact, start: float, end: float) -> Contact:
    """What lies between two instants, s; nothing does where it ends before it begins."""
    return replace(contact, start=max(contact.start, start), end=min(contact.end, end))
