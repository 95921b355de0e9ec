"""Flight summaries: the pelvis's crouch and apex heights, the flight's length, and what lengthened
it."""

from collections.abc import Callable, Iterator, Sequence

import numpy as np

from ..arrays import FloatArray
from ..data.contacts import ContactSchedule, Phase, PhaseKind
from ..data.reports.jumps import FlightSummary, JumpReport, LiftedFlight, RecordedFlight
from ..fitting.fit import Fit
from ..numerics.interpolation import interpolate
from ..stages.setup import Setup
from ..transcription.motion import Motion

LONGER = 0.05  # s, by which a flight is seen to be longer
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
        stood, stands = _before(flight, fit.schedule.phases), _before(now, schedule.phases)
        if stood is not None and stands is not None:
            sunk = _lowest(fit.motion, stood) - _lowest(motion, stands)
            risen = _risen(_stood_on(fit.motion, stood), _stood_on(motion, stands))
            deeper = 100.0 * (sunk + risen)
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


def _risen(before: dict[str, float], after: dict[str, float]) -> float:
    """By how much, m, what is stood on is higher, of heights by contacts' names."""
    risen = [after[name] - height for name, height in before.items() if name in after]
    return float(np.mean(risen)) if risen else 0.0


def _stood_on(motion: Motion, phase: Phase) -> dict[str, float]:
    """Heights, m, world, of the contacts that touch in a phase, by their names, amid it."""
    heights = {}
    for each in motion.transcription.contacts:
        first, last = max(each.contact.start, phase.start), min(each.contact.end, phase.end)
        if first < last:
            middle = np.array([0.5 * (first + last)])
            heights[each.contact.name] = float(motion.contact_points(middle)[0, each.point, 2])
    return heights


def lifted_flights(setup: Setup) -> Iterator[LiftedFlight]:
    """The flights that are longer, and seen to be so, for contacts that a problem lifts."""
    context, fit = setup.context, setup.fit
    spans = {phase.name: phase for phase in context.phases}  # with all contacts
    for now in context.schedule.phases:
        if now.kind is not PhaseKind.FLIGHT:
            continue
        inside = [_shared(now, p) for p in spans.values() if p.kind is PhaseKind.FLIGHT]
        lifts = [r.name for r in setup.requests.lifts if _shared(now, spans[r.phase]) > 0.0]
        if lifts and now.end - now.start > sum(inside) + LONGER:
            yield LiftedFlight(
                lifts=tuple(lifts),
                first_frame=scene_frame(fit, now.start),
                last_frame=scene_frame(fit, now.end),
                with_contacts_s=sum(inside),
                without_s=now.end - now.start,
            )


def _shared(a: Phase, b: Phase) -> float:
    """How long two phases overlap, s."""
    return max(0.0, min(a.end, b.end) - max(a.start, b.start))


def _flight_summary(
    motion: Motion, flight: Phase, phases: Sequence[Phase], floor: float
) -> FlightSummary:
    """floor: m, world."""
    stance = _before(flight, phases)
    return FlightSummary(
        crouch_pelvis_height_m=None if stance is None else _lowest(motion, stance) - floor,
        apex_pelvis_height_m=apex(motion, flight) - floor,
        flight_length_m=_length(motion, flight),
    )


def _before(flight: Phase, phases: Sequence[Phase]) -> Phase | None:
    """The phase before a flight; None where the clip begins with it."""
    before = [phase for phase in phases if phase.end <= flight.start + 1e-9]
    return before[-1] if before else None


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
