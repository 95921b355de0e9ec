"""What is hardly meant by a job, or wrong with its recording: all told before the fit."""

from __future__ import annotations

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
    up_doubts,
)


def doubts_about(
    problem: MotionProblem, repairs: Repairs | None, subject: Subject, origin: Origin
) -> list[str]:
    """A line for each. problem: as it was asked for. subject: the analysis of what it is about."""
    frames = subject.recording.frames
    doubts = file_doubts(origin) + doubts_of(
        problem, subject.height, frames[:0] if problem.loop else frames
    )
    unscaled = scaled_recording(subject.recording, 1.0 / subject.factor)
    doubts += distance_doubts(problem, unscaled.heads)
    doubts += damage_doubts(faults_of(unscaled, problem))
    if repairs is None:
        return doubts
    lies = find_up(subject.recording, figure_of(subject.recording, problem.bones)) is not None
    doubts += up_doubts(repairs.up, lies=lies)
    feet, on_objects = subject.schedule.floor_m, bool(subject.stood_on)
    return doubts + floor_doubts(repairs.floor, feet, on_objects=on_objects)
