"""The artist's corrections of contacts, which are the last word."""

from collections.abc import Set
from dataclasses import replace

from ..contacts.events import snap
from ..data.constants import UP
from ..data.contacts import Contact, ContactSchedule
from ..data.faults import BadTiming, BesideFrames, UnknownContactName
from ..data.problem import MotionProblem
from ..scene.support import LEAST_HEIGHT, StandingGround
from .performance import Performance, contact_points, snap_tolerance


def corrected(
    schedule: ContactSchedule, problem: MotionProblem, performance: Performance
) -> ContactSchedule:
    """The schedule with the artist's corrections; unchanged contacts keep their exact instants.

    Raises UnknownContactName, BadTiming, BesideFrames.
    """
    if not problem.contacts and not problem.added:
        return schedule
    contacts: dict[str, Contact] = {c.name: c for c in schedule.contacts}
    first = float(performance.recording.frames[0])
    rate = performance.recording.rate
    for edit in problem.contacts:
        if edit.name not in contacts:
            raise UnknownContactName(edit.name, tuple(contacts))
        contact = contacts[edit.name]
        if edit.remove:
            del contacts[edit.name]
            continue
        start, end = contact.start, contact.end
        if edit.start_frame is not None:
            start = (edit.start_frame - first) / rate
        if edit.end_frame is not None:
            end = (edit.end_frame - first) / rate
        span = (max(start, 0.0), min(end, schedule.duration))
        contacts[edit.name] = replace(contact, start=span[0], end=span[1])
    every = [*contacts.values()]
    ground = StandingGround.of(schedule.floor_m, problem.scene, performance.recording)
    known = {contact.on for contact in schedule.contacts}
    for added in problem.added:
        span = ((added.start_frame - first) / rate, (added.end_frame - first) / rate)
        within = (max(span[0], 0.0), min(span[1], schedule.duration))
        if within[0] > within[1] and span[0] <= span[1]:
            beside = added.start_frame if span[0] > 0.0 else added.end_frame
            raise BesideFrames(added.point, beside, *performance.recording.ends)
        every.append(_added(added.point, within, performance, ground, known))
    return snap(replace(schedule, contacts=tuple(every)), snap_tolerance(performance))


def _added(
    name: str,
    span: tuple[float, float],
    performance: Performance,
    ground: StandingGround,
    known: Set[str | None],
) -> Contact:
    """Contact of a point during (start, end) s, at the point's mean position then, and on what
    is there. Near the recording's floor that counts only where it is known that contacts are on it:
    elsewhere they are on the floor, and one that goes on from them would step up."""
    points, _ = contact_points(performance)
    if name not in points:
        raise UnknownContactName(name, tuple(points))
    point = points[name]
    during = (performance.times >= span[0]) & (performance.times <= span[1])
    if not during.any():
        raise BadTiming(name, span[1] - span[0])
    place = point.track[during].mean(axis=0)
    sole = place - point.depth * UP
    on = ground.at(sole)
    if on not in known and sole[2] < ground.floor_m + LEAST_HEIGHT:
        on = None
    return Contact(name, name, point.bone, point.offset, *span, place, on=on)
