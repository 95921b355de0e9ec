"""Flight summaries: the pelvis's crouch and apex heights, and the flight's length."""

from collections.abc import Callable, Iterator, Sequence

import numpy as np

from ..arrays import FloatArray
from ..data.contacts import ContactSchedule, Phase, PhaseKind
from ..data.reports.jumps import FlightSummary, JumpReport, RecordedFlight
from ..fitting.fit import Fit
from ..numerics.interpolation import interpolate
from ..transcription.motion import Motion

FrameOf = Callable[[float], float]  # the scene's frame at an instant, s


def frames_per_second(fit: Fit) -> float:
    """Frame rate of a fit's recording, 1/s."""
    return fit.performance.recording.rate


def scene_frame(fit: Fit, time: float) -> float:
    """The scene's frame at an instant of the clip (s), to a thousandth."""
    return round(float(fit.performance.recording.frames[0]) + time * frames_per_second(fit), 3)


def jumps(fit: Fit, motion: Motion, schedule: ContactSchedule) -> Iterator[JumpReport]:
    """Each flight of the fit that the adapted motion still has, before and after.

    motion: the adapted one; schedule: its phases.
    """
    after = {phase.name: phase for phase in schedule.phases}
    floor = fit.schedule.floor_m
    for flight in flights(fit):
        if flight.name not in after:
            continue
        now = after[flight.name]
        before = _flight_summary(fit.motion, flight, fit.schedule.phases, floor)
        adapted = _flight_summary(motion, now, schedule.phases, floor)
        deeper = None
        crouches = (before.crouch_pelvis_height_m, adapted.crouch_pelvis_height_m)
        if crouches[0] is not None and crouches[1] is not None:
            deeper = 100.0 * (crouches[0] - crouches[1])
        yield JumpReport(
            flight=flight.name,
            take_off_s=now.start,
            landing_s=now.end,
            take_off_frame=scene_frame(fit, now.start),
            landing_frame=scene_frame(fit, now.end),
            recorded=RecordedFlight(recorded_apex(fit, flight) - floor),
            fit=before,
            adapted=adapted,
            crouch_deeper_cm=deeper,
            apex_higher_cm=100.0 * (adapted.apex_pelvis_height_m - before.apex_pelvis_height_m),
        )


def _flight_summary(
    motion: Motion, flight: Phase, phases: Sequence[Phase], floor: float
) -> FlightSummary:
    """floor: m, world."""
    before = [phase for phase in phases if phase.end <= flight.start + 1e-9]
    return FlightSummary(
        crouch_pelvis_height_m=_lowest(motion, before[-1]) - floor if before else None,
        apex_pelvis_height_m=apex(motion, flight) - floor,
        flight_length_m=_length(motion, flight),
    )


def flights(fit: Fit) -> list[Phase]:
    """The flights of a fit, in order."""
    return [p for p in fit.schedule.phases if p.kind is PhaseKind.FLIGHT]


def _within(phase: Phase) -> FloatArray:
    return np.linspace(phase.start, phase.end, 2 + int((phase.end - phase.start) * 240.0))


def apex(motion: Motion, flight: Phase) -> float:
    """The pelvis's greatest height in a flight, m, world."""
    return float(motion.joint_centres(_within(flight))[:, 0, 2].max())


def recorded_apex(fit: Fit, flight: Phase) -> float:
    """The pelvis's greatest height in a flight of the recording, m, world."""
    performance = fit.performance
    heights = performance.centres[:, 0, 2]
    return float(interpolate(performance.times, heights, _within(flight)).max())


def _lowest(motion: Motion, phase: Phase) -> float:
    """The pelvis's least height in a phase, m, world."""
    return float(motion.joint_centres(_within(phase))[:, 0, 2].min())


def _length(motion: Motion, flight: Phase) -> float:
    """Horizontal travel of the centre of mass in a flight, m."""
    ends = motion.com(np.array([flight.start, flight.end]))
    return float(np.linalg.norm((ends[1] - ends[0])[:2]))
