"""The pipeline: recording and problem to analysis, fit, adaptation, report and traces.

subject = measure(recording, problem)
result = solve(subject, StageClock())
result.track, result.report(origin), result.traces()

Worker, command line, gallery and figures go through here. A stated stature scales the recording for
the solver, and the answer back: what comes out is in the recording's own lengths, but for the
report and the adaptation itself.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ..analysis.analyse import Analysis, analyse, build_figure
from ..analysis.pins.pinned_places import chosen_contacts, phase_of
from ..body.inverse_dynamics import InverseDynamics
from ..constraints.bone_names import check_bones
from ..data.contacts import ContactSchedule, gaps
from ..data.faults import NoFit, NoSolution, OffBalance, Treadmill, UnseenSupport, computable
from ..data.loop import Cycle
from ..data.problem import MotionProblem
from ..data.recording import PoseTrack, Recording
from ..data.reports.certificate import CertificateItem
from ..data.reports.jumps import TimeMap
from ..data.reports.recording import Origin
from ..data.reports.report import Report, StageReport
from ..data.scaling import (
    scaled_box,
    scaled_problem,
    scaled_recording,
    scaled_schedule,
    scaled_track,
)
from ..data.scene import SceneObject
from ..data.stance_move import StanceMove
from ..data.status import Status
from ..data.traces import Traces, scaled_traces
from ..doctor.examination.mistaken_support import with_cause
from ..doctor.examination.repair import as_asked, floated
from ..doctor.examination.suspects import damages_of
from ..fitting.fit import Fit
from ..fitting.lasting_fit import lasting_fit
from ..loops.find_cycle import check_loop, find_cycle
from ..loops.loop_report import loop_report
from ..results.certificate import LIMITS
from ..results.fit_quality import fit_quality
from ..results.joint_report import joint_turns
from ..results.last_stance import last_stance_move
from ..results.report import report, time_map
from ..results.trace_sampling import motion_traces, recorded_traces
from ..results.unseen_support import refuse_unseen
from ..results.violations import most_telling
from ..scene.checks import check_scene
from ..solid.flesh import shape_flesh
from ..solid.shape_changes import ShapeChanges
from ..stages.implicit import Adaptation, adapt, unadapted
from ..stages.platforms import recorded_rides
from ..transcription.motion import Motion
from .edited_part import edited_part
from .other_phases import on_phases_of
from .possible import check_requested, stand_in
from .stage_clock import StageClock
from .stated_scale import own_lengths

APART, LEAST_SOUND = 0.1, 0.5  # s: about what cannot be held; of a part that is worth keeping
FITTING, ADAPTING = "Fitting the physics", "Adapting"


@dataclass(frozen=True)
class Subject:
    """An analysed recording and the problem to solve on it, both at the stated stature.

    height: m, as recorded. factor: the stated stature over that one. cycle: of a motion that shall
    repeat, whose frames were analysed; None of others. floated: (3,) m, how far the recording is at
    its end from where it is held to the ground, in its own lengths.
    """

    analysis: Analysis
    problem: MotionProblem
    height: float
    factor: float
    cycle: Cycle | None = None
    floated: tuple[float, ...] = (0.0, 0.0, 0.0)

    @property
    def recording(self) -> Recording:
        """The problem's frames, at the stated stature."""
        return self.analysis.performance.recording

    def asked(self, problem: MotionProblem) -> Subject:
        """The same recording with another problem, in the recording's own lengths."""
        if problem.height is not None:
            problem = scaled_problem(problem, self.factor)
        return replace(self, problem=problem)

    @property
    def stood_on(self) -> frozenset[str]:
        """Names of the scene's objects that the recording is on."""
        every = self.analysis.schedule.contacts
        return frozenset(contact.on for contact in every if contact.on is not None)

    def edited(self) -> Subject:
        """The part of it that its problem is about. Raises UnknownPhase."""
        return replace(self, analysis=edited_part(self.analysis, self.problem))

    def with_objects(self, things: tuple[SceneObject, ...]) -> Subject:
        """The same with more objects in the scene, at the stated stature."""
        problem = replace(self.problem, scene=(*self.problem.scene, *things))
        return replace(self, problem=problem)

    @property
    def schedule(self) -> ContactSchedule:
        """The contacts found, in the recording's own lengths."""
        return scaled_schedule(self.analysis.schedule, 1.0 / self.factor)

    @property
    def drifted(self) -> tuple[float, float, float]:
        """How far, m, the recording is at its end from where it is without drift and held to the
        ground, in its own lengths."""
        (x, y), z = self.problem.drift, self.problem.rise
        (a, b, c), seconds = self.floated, float(self.recording.times[-1])
        return a + x * seconds, b + y * seconds, c + z * seconds

    @property
    def shape_changes(self) -> ShapeChanges:
        """Of the recording's own figure. Raises StillBone, NotAboveZero."""
        performance = self.analysis.performance
        flesh = shape_flesh(self.problem, performance)
        return ShapeChanges.of(self.problem.requests.shapes, performance.character, flesh)

    @property
    def fleshed(self) -> tuple[str, ...]:
        """Names of the bodies whose solid shapes are from the mesh."""
        performance = self.analysis.performance
        bodies = performance.character.bodies
        return tuple(bodies[i].name for i in shape_flesh(self.problem, performance))

    def recorded_traces(self) -> Traces:
        """Of the recording, in its own lengths. Raises StillBone, NotAboveZero."""
        seen = recorded_traces(self.analysis.performance, self.shape_changes)
        return scaled_traces(seen, 1.0 / self.factor)

    def motion_traces(
        self,
        motion: Motion,
        schedule: ContactSchedule,
        changes: ShapeChanges,
        *,
        torques: bool = True,
    ) -> Traces:
        """Of a solved motion, in the recording's own lengths. schedule, changes: of the motion."""
        dynamics = dynamics_of(motion) if torques else None
        seen = motion_traces(motion, self.recording, schedule, dynamics, changes)
        return scaled_traces(seen, 1.0 / self.factor)


@dataclass(frozen=True)
class AdaptationResult:
    """The end of a run. fault: why it is not what was asked for but the best that was found."""

    subject: Subject
    adaptation: Adaptation
    fault: NoSolution | None

    @property
    def recording(self) -> Recording:
        """The recording on the figure that the motion is for, in its own lengths."""
        return scaled_recording(self.adaptation.setup.recording, 1.0 / self.subject.factor)

    @property
    def track(self) -> PoseTrack:
        """The bones' poses, in the recording's own lengths."""
        return scaled_track(self.adaptation.track, 1.0 / self.subject.factor)

    @property
    def schedule(self) -> ContactSchedule:
        """The motion's contacts, in the recording's own lengths."""
        return scaled_schedule(self.adaptation.setup.schedule, 1.0 / self.subject.factor)

    @property
    def times(self) -> TimeMap:
        """Where the recording's frames are in the motion."""
        return time_map(self.adaptation)

    @property
    def moved(self) -> StanceMove | None:
        """The last stance's move, in the recording's own lengths; None where there is none."""
        move = last_stance_move(self.adaptation)
        if move is None:
            return None
        return move.scaled(1.0 / self.subject.factor).from_elsewhere(self.subject.drifted)

    def traces(self) -> Traces:
        """In the recording's own lengths."""
        motion, setup = self.adaptation.motion, self.adaptation.setup
        seen = self.subject.motion_traces(motion, setup.schedule, setup.changes)
        _, times = motion.frames(self.subject.recording)
        return replace(seen, changes=joint_turns(self.adaptation, times))

    def report(self, origin: Origin, stages: list[StageReport] | None = None) -> Report:
        """At the stated stature. stages: None leaves out times."""
        made, cycle = (
            report(self.adaptation, self.subject.problem, origin, stages),
            self.subject.cycle,
        )
        if cycle is None:
            return made
        recorded = self.subject.analysis.performance.com
        return replace(made, loop=loop_report(self.adaptation.motion, cycle, recorded))


def measure(recording: Recording, problem: MotionProblem) -> Subject:
    """Analyses the problem's frames of a recording, or the cycle nearest to them for a loop.

    Raises what `analyse`, `find_cycle` and `check_loop` do.
    """
    made, recording = recording, as_asked(recording, problem)
    if problem.height is None:
        analysis, cycle = _analysed(recording, problem)
        away = floated(made, problem, float(analysis.performance.recording.frames[-1]))
        return Subject(analysis, problem, analysis.performance.character.height, 1.0, cycle, away)
    # Before any contact is sought: at a wrong scale none would be found.
    height = build_figure(recording, problem)[1].height
    factor = problem.height / height
    problem = scaled_problem(problem, factor)
    try:
        analysis, cycle = _analysed(scaled_recording(recording, factor), problem)
    except (UnseenSupport, Treadmill) as fault:
        raise _unscaled(fault, factor) from None
    unseen = tuple(
        each if isinstance(each, OffBalance) else _unscaled(each, factor)
        for each in analysis.unseen
    )
    away = floated(made, problem, float(analysis.performance.recording.frames[-1]))
    return Subject(replace(analysis, unseen=unseen), problem, height, factor, cycle, away)


def _unscaled(fault: UnseenSupport | Treadmill, factor: float) -> UnseenSupport | Treadmill:
    """What was found at the stated stature, in the recording's own lengths."""
    if isinstance(fault, Treadmill):
        return Treadmill(fault.speed / factor)
    return replace(fault, boxes=tuple(scaled_box(box, 1.0 / factor) for box in fault.boxes))


def _analysed(recording: Recording, problem: MotionProblem) -> tuple[Analysis, Cycle | None]:
    """The analysis, and the cycle that it is of where the motion shall repeat."""
    cycle = None
    if problem.loop:
        check_loop(problem)
        cycle, recording = find_cycle(recording, problem)
        problem = replace(problem, frames=cycle.frames)
    try:
        analysis = analyse(recording, problem)
    except UnseenSupport as fault:
        raise with_cause([fault], recording, problem.bones)[0] from None
    told = with_cause(analysis.unseen, recording, problem.bones)
    return replace(analysis, unseen=tuple(told)), cycle


def fit_subject(subject: Subject, clock: StageClock) -> Fit:
    """The valid motion nearest to the recording, solved or not. Raises NotComputable."""
    scene, recording = subject.problem.scene, subject.recording
    with clock.stage(FITTING), computable():
        fitted = lasting_fit(
            subject.analysis.performance,
            subject.analysis.schedule,
            lambda schedule: recorded_rides(schedule, scene, recording),
            good_enough=subject.problem.good_enough * subject.factor,
            periodic=subject.cycle is not None,
            progress=clock.step,
        )
        clock.ended(fitted.outcome.violation)
    return fitted


def adapt_fit(subject: Subject, fitted: Fit, clock: StageClock) -> AdaptationResult:
    """Adapts the subject's fit to its problem. Raises what `adapt`, `on_fit` and `refuse_unseen`
    do, and NotComputable."""
    if not fitted.solved:
        return AdaptationResult(subject, unadapted(fitted), no_fit(subject, fitted))
    refuse_unseen(subject.problem, fitted)
    subject = on_fit(subject, fitted)
    with clock.stage(ADAPTING), computable():
        adaptation = adapt(fitted, subject.problem, progress=clock.step)
        clock.ended(adaptation.outcome.violation)
    if adaptation.solved:
        return AdaptationResult(subject, adaptation, None)
    fault = _unsolved(NoSolution, adaptation, subject.problem)
    fault = replace(_explained(fault, subject), fit_off_cm=_too_far_off(fitted))
    return AdaptationResult(subject, adaptation, fault)


def on_fit(subject: Subject, fitted: Fit) -> Subject:
    """The subject, its problem in the fit's phases and contacts. Raises as `on_phases_of` does."""
    found = subject.analysis.schedule
    problem = on_phases_of(subject.problem, found, fitted.schedule, subject.recording)
    return replace(subject, problem=problem)


def unfitted(subject: Subject) -> Fit:
    """What stands for the subject's fit until there is one, and hangs on nothing else."""
    schedule = subject.analysis.schedule
    return stand_in(
        subject.analysis.performance,
        schedule,
        periodic=subject.cycle is not None,
        rides=recorded_rides(schedule, subject.problem.scene, subject.recording),
    )


def fit_possible(subject: Subject, clock: StageClock) -> Fit:
    """The fit, once nothing that is asked is seen to be impossible. Raises as `check_requested`."""
    with own_lengths(subject.factor):
        check_requested(unfitted(subject), subject.problem)
    return fit_subject(subject, clock)


def solve(
    subject: Subject,
    clock: StageClock,
    fitted_by: Callable[[Subject, StageClock], Fit] = fit_possible,
) -> AdaptationResult:
    """The whole way from an analysis, of the part that is edited. fitted_by: may remember fits.

    Raises what `adapt` and `check_scene` do, all before the fit takes its seconds.
    """
    check_scene(subject.problem)
    check_loop(subject.problem)
    performance, schedule = subject.analysis.performance, subject.analysis.schedule
    requests = subject.problem.requests
    check_bones(requests, performance.character, performance.recording)
    ShapeChanges.of(requests.shapes, performance.character)
    for pin in subject.problem.pins:
        chosen_contacts(pin, phase_of(pin, schedule), schedule)
    subject = subject.edited()
    return adapt_fit(subject, fitted_by(subject, clock), clock)


def no_fit(subject: Subject, fitted: Fit, *, examined: bool = False) -> NoSolution:
    """The fault of a fit that failed, with what is wrong with the recording unless that is
    examined already."""
    fault = _unsolved(NoFit, unadapted(fitted), MotionProblem())
    if not isinstance(fault, NoFit):
        return fault
    fault = replace(fault, sound=_sound(fitted))
    return fault if examined else _explained(fault, subject)


def _explained(fault: NoSolution, subject: Subject) -> NoSolution:
    """With what is wrong with the recording, in its own lengths, where that may be the cause: not
    of a solve that the artist stopped, nor where all that is asked for holds."""
    if fault.reason in (Status.STOPPED, Status.NO_BODY):
        return fault
    recording = scaled_recording(subject.recording, 1.0 / subject.factor)
    return replace(fault, damages=damages_of(recording, subject.problem))


def _too_far_off(fitted: Fit) -> float:
    """Cm, rms, that a fit is off its recording; 0 where that is within the certificate's limit."""
    off = fit_quality(fitted).joint_centres_rms_cm
    return off if off > LIMITS[CertificateItem.FIT_RMS][0] else 0.0


def _sound(failed: Fit) -> tuple[int, int] | None:
    """First and last frame of the longest part of a failed fit in which its rows hold."""
    outcome, recording = failed.outcome, failed.performance.recording
    rows = outcome.transcription.rows(outcome.x, outcome.places)
    wrong = rows.time[np.abs(rows.violation()) > rows.tolerance]
    spans = [(t - APART, t + APART) for t in wrong]
    longest = max(
        gaps(spans, float(recording.times[-1])), key=lambda g: g.end - g.start, default=None
    )
    if not len(wrong) or longest is None or longest.end - longest.start < LEAST_SOUND:
        return None
    first, last = np.interp((longest.start, longest.end), recording.times, recording.frames)
    return int(np.ceil(first)), int(np.floor(last))


def dynamics_of(motion: Motion) -> InverseDynamics:
    """Inverse dynamics of a motion's own character and contact points."""
    return InverseDynamics(motion.transcription.character, motion.transcription.points)


def _unsolved(kind: type[NoSolution], adaptation: Adaptation, problem: MotionProblem) -> NoSolution:
    reason, worst = adaptation.outcome.status, most_telling(adaptation, problem)
    asked = () if reason is Status.STOPPED else problem.names
    return kind(reason, worst, adaptation.reached, asked=asked)
