"""From a recording and what the artist asks to an adapted motion: the calls that others make.

analysis = analyse(recording, problem)      # character, contacts
fitted = fit(analysis.performance, analysis.schedule)
adaptation = adapt(fitted, problem)
track = adaptation.motion.track(analysis.performance.recording)
"""

from dataclasses import dataclass, replace

from .character import build_character
from .contacts import Contact, ContactSchedule, snap
from .detection import require_flight
from .faults import ClipTooShort, UnknownContactName, UnseenSupport
from .performance import Performance, contact_points, find_contacts, perform, snap_tolerance
from .problem import ContactEdit, MotionProblem
from .recording import Recording

SHORTEST_CLIP = 0.3  # s


@dataclass(frozen=True)
class Analysis:
    """What a recording shows: the figure's movement and its contacts."""

    performance: Performance
    schedule: ContactSchedule


def analyse(recording: Recording, problem: MotionProblem) -> Analysis:
    """Finds character and contacts in the problem's frames of a recording.

    Raises ClipTooShort, NoFlight, UnseenSupport, MissingPart, ZeroLengthBone, UnknownContactName.
    """
    if problem.frames is not None:
        recording = recording.window(*problem.frames)
    seconds = float(recording.times[-1]) if len(recording.times) else 0.0
    if seconds < SHORTEST_CLIP:
        raise ClipTooShort(seconds, SHORTEST_CLIP)
    character = build_character(
        recording, mass=problem.mass, table=problem.mass_table, chosen=problem.bones
    )
    performance = perform(recording, character)
    schedule = _corrected(find_contacts(performance), problem.contacts, performance)
    for gap in schedule.unseen:
        raise UnseenSupport(_frame(recording, gap.start), _frame(recording, gap.end))
    require_flight(schedule, contact_points(performance)[0])
    return Analysis(performance, schedule)


def _frame(recording: Recording, time: float) -> float:
    rate = (len(recording.times) - 1) / float(recording.times[-1])
    return float(round(recording.frames[0] + time * rate))


def _corrected(
    schedule: ContactSchedule, edits: tuple[ContactEdit, ...], performance: Performance
) -> ContactSchedule:
    """The schedule with the artist's corrections; unchanged contacts keep their exact instants."""
    if not edits:
        return schedule
    contacts: dict[str, Contact] = {c.name: c for c in schedule.contacts}
    first = float(performance.recording.frames[0])
    rate = (len(performance.times) - 1) / float(performance.times[-1])
    for edit in edits:
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
    edited = replace(schedule, contacts=tuple(contacts.values()))
    return snap(edited, snap_tolerance(performance))
