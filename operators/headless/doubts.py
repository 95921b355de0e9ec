"""What is hardly meant by a job, or wrong with its recording: all told before the fit."""

from __future__ import annotations

from dataclasses import replace

from ...solver.analysis.grounding import strays
from ...solver.analysis.leaps import Leap, Stand, leaps
from ...solver.analysis.pinned_places import backward_stances, pinned_places
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
    doubts += contact_doubts(problem, _strays(subject))
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


def _strays(subject: Subject) -> dict[str, tuple[float, float]]:
    """In lengths as recorded, with the scene's frames."""
    found, recording = subject.analysis, subject.recording
    return {
        name: (away / subject.factor, float(recording.frames[0]) + recording.rate * when)
        for name, (away, when) in strays(found.schedule, found.performance).items()
    }
