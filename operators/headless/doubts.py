"""What is hardly meant by a job, or wrong with its recording: all told before the fit."""

from __future__ import annotations

from dataclasses import replace

from ...solver.analysis.grounding import Stray, strays
from ...solver.analysis.leaps import Leap, Stand, leaps
from ...solver.analysis.pins.pinned_places import backward_stances, pinned_places
from ...solver.data.contacts import Contact
from ...solver.data.faults import Fault
from ...solver.data.problem import MotionProblem
from ...solver.data.reports.recording import Origin
from ...solver.data.scaling import scaled_recording
from ...solver.doctor.examination.suspects import faults_of
from ...solver.doctor.figure import figure_of
from ...solver.doctor.repairs import Repairs
from ...solver.doctor.upright import find_up
from ...solver.worker.pipeline import Subject
from ..words.doubt_text import (
    damage_doubts,
    distance_doubts,
    doubts_of,
    file_doubts,
    floor_doubts,
    rise_doubts,
    up_doubts,
)
from ..words.request_doubt_text import contact_doubts, direction_doubts

SNAPPED = 0.1  # s, by which an end of an edited contact may have been put elsewhere


def doubts_about(
    problem: MotionProblem, repairs: Repairs | None, subject: Subject, origin: Origin
) -> list[str]:
    """A line for each. problem: as it was asked for. subject: the analysis of what it is about."""
    frames = subject.recording.frames
    doubts = file_doubts(origin) + doubts_of(
        problem,
        subject.height,
        frames[:0] if problem.loop else frames,
        subject.schedule.phases,
        _leaps(subject),
    )
    found = subject.analysis
    doubts += direction_doubts(problem, backward_stances(found.performance, found.schedule))
    doubts += contact_doubts(_strays(subject), 1.0 / subject.factor, subject.recording.frame_at)
    unscaled = scaled_recording(subject.recording, 1.0 / subject.factor)
    doubts += distance_doubts(problem, unscaled.heads)
    doubts += damage_doubts(faults_of(unscaled, problem))
    if repairs is None:
        return doubts
    lies = find_up(subject.recording, figure_of(subject.recording, problem.bones)) is not None
    doubts += rise_doubts(repairs.rise)
    doubts += up_doubts(repairs.up, lies=lies)
    feet, on_objects = subject.schedule.floor_m, bool(subject.stood_on)
    return doubts + floor_doubts(repairs.floor, feet, on_objects=on_objects)


def _leaps(subject: Subject) -> list[Leap]:
    """In true lengths; none where a pin is wrong, which the solve refuses in words."""
    schedule, recording = subject.analysis.schedule, subject.recording
    still = {thing.name for thing in subject.problem.scene if not thing.moves}
    pins = (
        pin if pin.on in still else replace(pin, on=None)  # what moves is elsewhere by then
        for pin in subject.problem.pins
    )
    try:
        asked = pinned_places(
            replace(subject.problem, pins=tuple(pins)), subject.analysis.performance, schedule
        )
    except Fault:
        return []
    stands = (
        Stand(contact.start, contact.end, contact.place, place)
        for contact, place in zip(schedule.contacts, asked, strict=True)
    )
    return leaps(schedule.phases, stands, recording.times, recording.heads)


def _strays(subject: Subject) -> list[Stray]:
    """Of the contacts that the artist added, or edited."""
    found, problem, recording = subject.analysis, subject.problem, subject.recording
    edited = {edit.name for edit in problem.contacts}

    def is_of_artist(contact: Contact) -> bool:
        """By name, or by when it is: those of its point are counted anew after an addition."""
        if contact.name in edited:
            return True
        first, last = (recording.frame_at(at) for at in (contact.start, contact.end))
        near = SNAPPED * recording.rate
        return any(
            each.name.rpartition(" ")[0] == contact.point
            and (_near(each.start_frame, first, near) or _near(each.end_frame, last, near))
            for each in problem.contacts
        ) or any(
            each.point == contact.point and each.start_frame < last and first < each.end_frame
            for each in problem.added
        )

    return [s for s in strays(found.schedule, found.performance) if is_of_artist(s.contact)]


def _near(asked: float | None, found: float, reach: float) -> bool:
    return asked is not None and abs(asked - found) <= reach
