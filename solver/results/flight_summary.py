"""What becomes of each flight: heights of the pelvis before and in it, and how far it carries."""

from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..data.contacts import ContactSchedule, Phase, PhaseKind
from ..numerics.interpolation import interpolate
from ..stages.fit import Fit
from ..transcription.motion import Motion


def frames_per_second(fit: Fit) -> float:
    """Of the recording, 1/s."""
    recording = fit.performance.recording
    return (len(recording.times) - 1) / float(recording.times[-1])


def scene_frame(fit: Fit, time: float) -> float:
    """The scene's frame at an instant of the clip, s."""
    return round(float(fit.performance.recording.frames[0]) + time * frames_per_second(fit), 3)


def jumps(fit: Fit, motion: Motion, schedule: ContactSchedule) -> list[dict[str, Any]]:
    """Each flight before and after: pelvis heights above the floor, and the flight's reach.

    motion: the adapted one; schedule: its phases.
    """
    floor = fit.schedule.floor_m
    after = {phase.name: phase for phase in schedule.phases}
    found = []
    for flight in flights(fit):
        if flight.name not in after:
            continue
        now = after[flight.name]
        was_before, now_before = (
            [p for p in phases if p.end <= start + 1e-9]
            for phases, start in (
                (fit.schedule.phases, flight.start),
                (schedule.phases, now.start),
            )
        )
        both = ((fit.motion, flight, was_before), (motion, now, now_before))
        before, adapted = (
            {
                "crouch_pelvis_height_m": _lowest(m, stance[-1]) - floor if stance else None,
                "apex_pelvis_height_m": apex(m, phase) - floor,
                "flight_length_m": _reach(m, phase),
            }
            for m, phase, stance in both
        )
        deeper = None
        if was_before and now_before:
            deeper = 100.0 * (_lowest(fit.motion, was_before[-1]) - _lowest(motion, now_before[-1]))
        found.append(
            {
                "flight": flight.name,
                "take_off_s": now.start,
                "landing_s": now.end,
                "take_off_frame": scene_frame(fit, now.start),
                "landing_frame": scene_frame(fit, now.end),
                "recorded": {"apex_pelvis_height_m": recorded_apex(fit, flight) - floor},
                "fit": before,
                "adapted": adapted,
                "crouch_deeper_cm": deeper,
                "apex_higher_cm": 100.0 * (apex(motion, now) - apex(fit.motion, flight)),
            }
        )
    return found


def flights(fit: Fit) -> list[Phase]:
    return [p for p in fit.schedule.phases if p.kind is PhaseKind.FLIGHT]


def _within(phase: Phase) -> FloatArray:
    return np.linspace(phase.start, phase.end, 2 + int((phase.end - phase.start) * 240.0))


def apex(motion: Motion, flight: Phase) -> float:
    """The pelvis's greatest height in a flight, m, world."""
    return float(motion.joint_centres(_within(flight))[:, 0, 2].max())


def recorded_apex(fit: Fit, flight: Phase) -> float:
    performance = fit.performance
    heights = performance.centres[:, 0, 2]
    return float(interpolate(performance.times, heights, _within(flight)).max())


def _lowest(motion: Motion, phase: Phase) -> float:
    """The pelvis's least height in a phase, m, world."""
    return float(motion.joint_centres(_within(phase))[:, 0, 2].min())


def _reach(motion: Motion, flight: Phase) -> float:
    """How far the centre of mass travels over the ground in a flight, m."""
    ends = motion.com(np.array([flight.start, flight.end]))
    return float(np.linalg.norm((ends[1] - ends[0])[:2]))
