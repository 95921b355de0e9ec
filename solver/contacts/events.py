"""Contacts told apart: instants that nearly coincide become one, and each contact is named by its
point and its count."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import groupby, pairwise

from ..data.contacts import Contact, ContactSchedule, Interval


def snap(schedule: ContactSchedule, tolerance_s: float) -> ContactSchedule:
    """Event times within tolerance_s of each other merged into one.

    The solver puts knots at these instants, and spans of a few milliseconds would spoil its
    equations. The clip's ends and the ends of flights keep their places; other instants go to
    the middle of their group. A contact that shrinks to nothing is dropped.
    """
    fixed = {0.0, schedule.duration}
    for flight in schedule.flights:
        fixed |= {flight.start, flight.end}
    goes_to = _merged(schedule.boundaries, fixed, tolerance_s)
    moved = (replace(c, start=goes_to[c.start], end=goes_to[c.end]) for c in schedule.contacts)
    unseen = (Interval(goes_to[u.start], goes_to[u.end]) for u in schedule.unseen)
    return replace(
        schedule,
        contacts=numbered(c for c in moved if c.end > c.start),
        unseen=tuple(u for u in unseen if u.end > u.start),
    )


def numbered(contacts: Iterable[Contact]) -> tuple[Contact, ...]:
    """The contacts by start, then point, each named by its point and its count in time."""
    by_point = groupby(sorted(contacts, key=lambda c: (c.point, c.start)), key=lambda c: c.point)
    named = [
        replace(contact, name=f"{point} {count}")
        for point, group in by_point
        for count, contact in enumerate(group, start=1)
    ]
    return tuple(sorted(named, key=lambda c: (c.start, c.point)))


def _merged(instants: Iterable[float], fixed: set[float], tolerance: float) -> dict[float, float]:
    """Clustering of instants, s, to centres: nearest ones merge until all are further apart."""
    groups = [[t] for t in sorted({*instants, *fixed})]
    while True:
        centres = [_centre(group, fixed) for group in groups]
        near = [
            (b - a, i)
            for i, (a, b) in enumerate(pairwise(centres))
            if b - a <= tolerance and not {a, b} <= fixed
        ]
        if not near:
            return {t: c for group, c in zip(groups, centres, strict=True) for t in group}
        _, i = min(near)
        groups[i : i + 2] = [groups[i] + groups[i + 1]]


def _centre(group: Sequence[float], fixed: set[float]) -> float:
    """The cluster's fixed instant, else the middle of its ends, s."""
    return next((t for t in group if t in fixed), (group[0] + group[-1]) / 2)
