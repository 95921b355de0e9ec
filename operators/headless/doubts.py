"""What is hardly meant by a job: its problem, and the repairs of its recording."""

from __future__ import annotations

from ...solver.data.problem import MotionProblem
from ...solver.doctor.figure import figure_of
from ...solver.doctor.repairs import Repairs
from ...solver.doctor.upright import find_up
from ...solver.worker.pipeline import Subject
from ..words.doubt_text import doubts_of, floor_doubts, up_doubts


def doubts_about(problem: MotionProblem, repairs: Repairs | None, subject: Subject) -> list[str]:
    """A line for each. problem: as it was asked for. subject: the analysis of what it is about."""
    frames = subject.recording.frames
    doubts = doubts_of(problem, subject.height, frames[:0] if problem.loop else frames)
    if repairs is None:
        return doubts
    lies = find_up(subject.recording, figure_of(subject.recording, problem.bones)) is not None
    doubts += up_doubts(repairs.up, lies=lies)
    feet, on_objects = subject.schedule.floor_m, bool(subject.stood_on)
    return doubts + floor_doubts(repairs.floor, feet, on_objects=on_objects)
