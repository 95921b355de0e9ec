"""Measures a report (data/reports/report.py): what was found and how well it holds."""

import math
from collections.abc import Iterator, Sequence
from functools import partial

import numpy as np

from ..arrays import FloatArray
from ..body.character import Character
from ..body.passive_joints import evaluate_passive_torques
from ..data.constants import STANDARD_GRAVITY
from ..data.contacts import Phase, PhaseKind
from ..data.problem import MotionProblem, OffsetAxes, Pin
from ..data.reports.constraints import ConstraintReport, ContactReport, PinReport
from ..data.reports.dynamics import (
    DenseResiduals,
    ForcePeak,
    ForcesReport,
    PhaseResidual,
    TorquePeak,
    TorquesReport,
    TorqueUse,
)
from ..data.reports.jumps import PhaseReport, TimeMap
from ..data.reports.recording import FigureSummary, Origin, RecordingSummary
from ..data.reports.report import (
    MotionChange,
    RecordedOverlap,
    ReductionReport,
    Report,
    SolveReport,
    StageReport,
)
from ..data.requests import ConeShape, Vector
from ..data.solver_options import Dynamics, Method
from ..fitting.fit import Fit
from ..optimisation.sqp import Outcome
from ..solid.shape_changes import AS_IS
from ..stages.implicit import Adaptation
from ..transcription.constraint import DenseViolation
from ..transcription.contact_pins import PointContact
from ..transcription.motion import DynamicsResidual, Motion
from ..transcription.sampling import Instants, State
from ..transcription.torque_constraint import TorqueFunction
from .certificate import (
    LoadedDrift,
    beside_recording,
    between_knots,
    certificate,
    friction_of,
    loaded_drifts,
)
from .fit_quality import fit_quality
from .flight_summary import (
    frames_per_second,
    jumps,
    lifted_flights,
    scene_frame,
)
from .joint_report import fast_joint, joint_changes, recorded_ranges
from .moving_ground import moving_ground
from .npz_export import instants
from .torque_curve import exact_torques, torque_curve
from .unseen_support import accepted, carried_flights, let_go, unseen_support
from .violations import condition_violations, pins_of_contacts, worst_constraints

SAMPLE_RATE = 1000.0  # Hz, of what is measured between the nodes


def report(
    adaptation: Adaptation,
    problem: MotionProblem,
    origin: Origin,
    stages: Sequence[StageReport] | None = None,
) -> Report:
    """The report on an adaptation of what `problem` asks for. stages: None leaves out times.

    Raises UnknownPhase, UnknownContact where a pin of the problem names none.
    """
    fit, motion, schedule = adaptation.fit, adaptation.motion, adaptation.setup.schedule
    transcription = motion.transcription
    pins = pins_of_contacts(fit, problem)
    drifts, quality = loaded_drifts(motion), fit_quality(fit)
    left, torques = between_knots(motion)
    conditions = condition_violations(adaptation)
    lines = certificate(motion, left, torques, drifts, quality, partial(scene_frame, fit))
    return Report(
        status=adaptation.outcome.status,
        certificate=lines if problem.asks_nothing else beside_recording(lines, fit),
        recording=_recording(fit, origin),
        figure=_figure(fit, motion, problem),
        pins=tuple(_pin(pin) for pin in problem.pins),
        solves=(*_solves(fit.outcomes, "fit"), *_solves(adaptation.outcomes, "adapt")),
        unknowns=transcription.n_unknowns,
        rows=len(transcription.values(motion.x, motion.places)),
        equations=tuple(worst_constraints(adaptation, problem, conditions, least=0.0)),
        conditions=tuple(_condition(each, fit, transcription.character) for each in conditions),
        contacts=tuple(
            _contact(adaptation, i, pins.get(each.contact.name), drifts[i])
            for i, each in enumerate(transcription.contacts)
        ),
        moving_ground=tuple(moving_ground(adaptation, problem)),
        between_nodes=dense_residuals(left, schedule.phases),
        forces=_forces(adaptation),
        objective_end_over_start=adaptation.gain,
        reduction=_reduction(adaptation),
        torques=_torques(adaptation, problem) if _in_play(problem) else None,
        torque_limits=tuple(_torque_uses(motion)),
        fit_to_recording=quality,
        recorded_overlaps=tuple(_recorded_overlaps(adaptation)),
        recorded_ranges=recorded_ranges(adaptation),
        change=change(adaptation),
        joint_changes=joint_changes(adaptation),
        jumps=tuple(jumps(fit, motion, schedule)),
        durations=adaptation.setup.durations,
        phases=_phases(adaptation),
        times=time_map(adaptation),
        fast_joint=fast_joint(adaptation),
        stages=None if stages is None else tuple(stages),
        unseen_support=tuple(unseen_support(fit, motion)),
        let_go=tuple(let_go(fit)),
        accepted_contacts=tuple(accepted(motion)),
        carried_flights=tuple(carried_flights(fit)),
        lifted_flights=tuple(lifted_flights(adaptation.setup)),
    )


# ---------------------------------------------------------------- what went in


def _recording(fit: Fit, origin: Origin) -> RecordingSummary:
    recording = fit.performance.recording
    return RecordingSummary(
        clip=origin.clip,
        action=recording.name,
        first_frame=float(recording.frames[0]),
        last_frame=float(recording.frames[-1]),
        seconds=float(recording.times[-1]),
        frames_per_second=frames_per_second(fit),
        unit_m=origin.unit_m,
        unit_guessed=origin.unit_guessed,
        up_axis=origin.up,
        up_axis_guessed=origin.up_guessed,
        bind_pose_frames=origin.bind_frames,
    )


def _figure(fit: Fit, motion: Motion, problem: MotionProblem) -> FigureSummary:
    character = motion.transcription.character  # which may carry more than the fit's
    return FigureSummary(
        mass_kg=character.mass,
        mass_table=problem.mass_table,
        height_m=character.height,
        gravity_m_s2=character.gravity,
        bodies=len(character.bodies),
        degrees_of_freedom=character.n_dofs,
        floor_m=fit.schedule.floor_m,
    )


def _pin(pin: Pin) -> PinReport:
    in_world = pin.axes is OffsetAxes.WORLD
    return PinReport(
        name=pin.name,
        phase=pin.phase,
        points=pin.touching,
        offset_world_m=pin.offset if in_world else None,
        offset_forward_left_up_m=None if in_world else pin.offset,
        place_m=pin.place,
        turn_deg=math.degrees(pin.turn),
        step=pin.step,
    )


def _solves(outcomes: Sequence[Outcome], name: str) -> list[SolveReport]:
    return [
        SolveReport(
            name=outcome.steps[0].stage if outcome.steps else name,
            status=outcome.status,
            iterations=len(outcome.steps),
            violation_over_tolerance=outcome.violation,
        )
        for outcome in outcomes
    ]


# ---------------------------------------------------------------- how well it holds


def _condition(missed: DenseViolation, fit: Fit, character: Character) -> ConstraintReport:
    return ConstraintReport(
        name=missed.name,
        kind=missed.kind,
        worst_violation=missed.kind.reported(missed.amount, character.mass * STANDARD_GRAVITY),
        worst_violation_frame=scene_frame(fit, missed.time),
        met=missed.amount <= missed.kind.tolerance,
    )


def _contact(adaptation: Adaptation, i: int, pin: str | None, loaded: LoadedDrift) -> ContactReport:
    fit, motion = adaptation.fit, adaptation.motion
    at = motion.transcription.contacts[i]
    contact = at.contact
    return ContactReport(
        name=contact.name,
        pin=pin,
        point=contact.point,
        bone=contact.bone,
        friction_coefficient=at.friction,
        friction_cone=_cone(at),
        start_s=contact.start,
        end_s=contact.end,
        start_frame=scene_frame(fit, contact.start),
        end_frame=scene_frame(fit, contact.end),
        fitted_place_m=_vector(adaptation.setup.fitted.places[i]),
        place_m=_vector(motion.places[i]),
        worst_violation_mm=1000.0 * loaded.furthest,
        worst_violation_frame=scene_frame(fit, loaded.furthest_at),
        loaded_slide_mm=1000.0 * float(loaded.slide.max(initial=0.0)),
        loaded_under_mm=1000.0 * float((-loaded.height).max(initial=0.0)),
        loaded_above_mm=1000.0 * float(loaded.height.max(initial=0.0)),
    )


def _vector(values: FloatArray) -> Vector:
    x, y, z = values.tolist()
    return x, y, z


def _cone(contact: PointContact) -> str:
    if contact.friction is None:
        return "none: a grip"
    shape = ConeShape.PYRAMID if contact.pyramid else ConeShape.EXACT
    return shape.value


def dense_residuals(left: DynamicsResidual, phases: Sequence[Phase]) -> DenseResiduals:
    """Dynamics residual between the nodes too, by kind of phase."""
    force, moment = (np.linalg.norm(part, axis=1) for part in (left.force, left.moment))
    found: dict[PhaseKind, PhaseResidual] = {}
    for kind in PhaseKind:
        inside = np.zeros(len(left.times), dtype=bool)
        for phase in phases:
            if phase.kind is kind:
                inside |= (left.times > phase.start) & (left.times < phase.end)
        if inside.any():
            found[kind] = PhaseResidual(
                force_rms_bw=_rms(force[inside]),
                force_max_bw=float(force[inside].max()),
                moment_rms_bw_m=_rms(moment[inside]),
                moment_max_bw_m=float(moment[inside].max()),
            )
    return DenseResiduals(SAMPLE_RATE, found.get(PhaseKind.GROUND), found.get(PhaseKind.FLIGHT))


def _forces(adaptation: Adaptation) -> ForcesReport:
    fit, motion = adaptation.fit, adaptation.motion
    times = instants(motion.duration, SAMPLE_RATE)
    forces = _forces_bw(motion, times)
    total = np.linalg.norm(forces.sum(axis=1), axis=1)
    friction = friction_of(motion, times, forces)
    peaks = []
    for phase in adaptation.setup.schedule.phases:
        inside = (times >= phase.start) & (times <= phase.end)
        if phase.kind is PhaseKind.GROUND and inside.any():
            at = int(np.argmax(np.where(inside, total, -1.0)))
            frame = scene_frame(fit, float(times[at]))
            needed = float(friction[inside].max())
            peaks.append(ForcePeak(phase.name, float(total[at]), frame, needed))
    recorded = _forces_bw(fit.motion, instants(fit.motion.duration, SAMPLE_RATE))
    return ForcesReport(
        tuple(peaks),
        float(np.linalg.norm(recorded.sum(axis=1), axis=1).max(initial=0.0)),
        float(forces[:, :, 2].min(initial=0.0)),
    )


def _forces_bw(motion: Motion, times: FloatArray) -> FloatArray:
    """(T, points, 3) contact forces at some times, s, in body weights."""
    weight = motion.transcription.character.mass * STANDARD_GRAVITY
    return np.asarray(motion.forces(times) / weight)


def _recorded_overlaps(adaptation: Adaptation) -> Iterator[RecordedOverlap]:
    fit, changes = adaptation.fit, adaptation.setup.changes
    if adaptation.setup.solid is not None:
        found = fit.overlaps if changes == AS_IS else fit.overlaps_of(changes)
        for each in found.worst():
            frame = scene_frame(fit, each.time)
            yield RecordedOverlap(each.name, 1000.0 * each.amount, frame)


def _reduction(adaptation: Adaptation) -> ReductionReport | None:
    space = adaptation.setup.space
    if space is None:
        return None
    return ReductionReport(
        kind=space.kind,
        degrees_of_freedom=space.basis.shape[1],
        eigenvalues_rad2=tuple(space.eigenvalues.tolist()),
        explained_share=tuple(space.explained.tolist()),
    )


def _in_play(problem: MotionProblem) -> bool:
    """True where the problem limits or weighs torques."""
    solution = problem.requests.solution
    return (
        bool(problem.requests.torques)
        or solution.method is not Method.IMPLICIT
        or solution.dynamics is Dynamics.STANDARD
    )


def _torques(adaptation: Adaptation, problem: MotionProblem) -> TorquesReport:
    motion, torques = adaptation.motion, adaptation.setup.torques
    times = (instants(motion.duration, SAMPLE_RATE) + 0.5 / SAMPLE_RATE)[:-1]
    sizes = np.abs(exact_torques(motion, torques, times))
    character = motion.transcription.character
    peaks = tuple(
        TorquePeak(body.bone, float(sizes[:, joint.first - 3 : joint.dofs.stop - 3].max()))
        for body, joint in zip(character.bodies[1:], character.joints[1:], strict=True)
    )
    curve = torque_curve(motion, torques, longest=problem.requests.solution.torque_span)
    return TorquesReport(peaks, curve.n_coefficients * sizes.shape[1], curve.error)


def _torque_uses(motion: Motion) -> Iterator[TorqueUse]:
    t = motion.transcription
    for limit in t.constraints:
        if isinstance(limit.function, TorqueFunction):
            times = limit.start + instants(limit.end - limit.start, SAMPLE_RATE)
            state = State(t.character, t.layout, Instants(t.basis, times), motion.x)
            muscles = limit.function.value(state) * t.character.mass * STANDARD_GRAVITY
            q, v = state.angles(), state.angles(1)
            passive = evaluate_passive_torques(t.character, q, v, orthogonal=True)
            yield TorqueUse(
                limit.name,
                float(np.abs(muscles).max()),
                _rms(muscles),
                float(np.abs(passive[:, limit.function.angles]).max()),
            )


# ---------------------------------------------------------------- what changed


def _phases(adaptation: Adaptation) -> tuple[PhaseReport, ...]:
    """Durations of the recording's phases that the motion still has."""
    line = adaptation.setup.context.timeline
    reports = []
    for phase in adaptation.fit.schedule.phases:
        start, end = (float(line.to_new(t)) for t in (phase.start, phase.end))
        if end > start:
            reports.append(PhaseReport(phase.name, phase.end - phase.start, end - start))
    return tuple(reports)


def time_map(adaptation: Adaptation) -> TimeMap:
    """Where the recording's frames are in the motion."""
    line = adaptation.setup.context.timeline
    recorded, adapted = (
        tuple(scene_frame(adaptation.fit, t) for t in times.tolist())
        for times in (line.old, line.new)
    )
    return TimeMap(recorded, adapted)


def change(adaptation: Adaptation) -> MotionChange:
    """Distance of the motion from the fit, at the recording's frames and on its own time."""
    times = adaptation.fit.performance.times
    moved = adaptation.setup.context.timeline.to_new(times)
    kept = moved <= adaptation.motion.duration
    was, now = adaptation.fit.motion, adaptation.motion
    places = now.joint_centres(moved[kept]) - was.joint_centres(times[kept])
    angles = now.angles(moved[kept])[:, 3:] - was.angles(times[kept])[:, 3:]
    return MotionChange(
        joint_centres_rms_cm=100.0 * _rms(np.linalg.norm(places, axis=2)),
        joint_angles_rms_deg=math.degrees(_rms(angles)),
    )


def _rms(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(values**2)))
