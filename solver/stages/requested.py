"""What a problem asks of a fit: body, contacts, places and times, and what of it is refused."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

from ..analysis.pins.pinned_places import pinned_by, travel_axes
from ..analysis.timeline import timeline
from ..arrays import FloatArray
from ..body.body_changes import changed_character, changed_points
from ..body.dynamics import MomentFunction
from ..body.proportions import changed_recording
from ..constraints.capped_forces import check_capped
from ..constraints.contact_setup import added_contact, with_added, without_lifted
from ..constraints.evaluation_context import EvaluationContext
from ..constraints.far_apart import check_apart
from ..constraints.held_pose import check_poses
from ..data.contacts import Interval, Phase
from ..data.faults import NeedsTorques
from ..data.problem import MotionProblem
from ..data.recording import Recording
from ..data.requests import Requests
from ..data.solver_options import Dynamics, Method, ObjectiveKind
from ..fitting.fit import Fit
from ..inverse_kinematics.reseat import reseat
from ..solid.flesh import shape_flesh
from ..solid.room import check_room
from ..solid.shape_changes import ShapeChanges
from ..transcription.motion import Motion
from .anticipation import Jump, changed_jumps
from .footing import check_sunk
from .initial_guess import resampled_fit
from .platforms import find_standing, recorded_in
from .warm_start import Standing

TORQUE_OBJECTIVES = (
    ObjectiveKind.TORQUE_SMOOTHNESS.value,
    ObjectiveKind.POWER.value,
    ObjectiveKind.TORQUE_OUTPUT.value,
    ObjectiveKind.TOTAL_CHANGE.value,
    Method.IMPLICIT_TORQUES.value,
)


@dataclass(frozen=True)
class Requested:
    """What is asked of a fit.

    start: the fit on the problem's contacts, where they were, without constraints. fitted: where
    contacts were in the fit; target: where they shall be. reference: the fit with the body that is
    asked for. recording: of that body. changes: of the solid shapes.
    """

    context: EvaluationContext
    start: Motion
    fitted: Standing
    target: Standing
    reference: Motion
    recording: Recording
    changes: ShapeChanges


def requested(fit: Fit, problem: MotionProblem) -> Requested:
    """What a problem asks of a fit.

    Raises UnknownPhase, UnknownContact, ContradictoryPins and the requests' own faults.
    """
    requests, recording = problem.requests, fit.performance.recording
    if requests.solution.dynamics is Dynamics.REDUCED:
        _refuse_torques(requests)
    rate = (len(recording.times) - 1) / float(recording.times[-1])
    first = float(recording.frames[0])
    retiming = timeline(fit.schedule, first, rate, requests.timings, requests.holds)
    retimed = retiming.schedule(fit.schedule)
    changed = changed_recording(recording, requests.body.limbs)
    reference = _with_body(fit, problem, changed)
    context = EvaluationContext(
        changed,
        fit.motion,
        reference,
        retimed.phases,
        without_lifted(retimed, problem),
        retiming,
        partial(travel_at, fit, retimed.phases),
    )
    added = {r.name: r for r in requests.points if r.environment}
    contacts = [added_contact(request, context) for request in added.values()]
    context = replace(context, schedule=with_added(context.schedule, contacts))
    target, footing = find_standing(fit, problem, context)
    start = resampled_fit(fit, problem, context, added, footing)
    fitted = Standing(start.places, recorded_in(fit, context))
    flesh = shape_flesh(problem, fit.performance)
    changes = ShapeChanges.of(requests.shapes, context.character, flesh)
    if requests.solution.solid:
        check_sunk(problem.scene, context.schedule, footing)
        if requests.solution.human:
            check_room(
                problem.scene, reference.transcription, context.schedule, target.places, changes
            )
    return Requested(context, start, fitted, target, reference, changed, changes)


def check_places(
    fit: Fit,
    problem: MotionProblem,
    context: EvaluationContext,
    start: Motion,
    fitted: Standing,
    target: Standing,
) -> None:
    """Refuses what is too far apart for any body, or for one whose pose is held. Raises
    ContradictoryPins, OutOfReach, PoseHeld.

    context, start: of the problem; fitted: where its contacts were; target: where they shall be.
    """
    if not target.moves:  # a train takes its riders further than they could go
        pinned = pinned_by(problem.pins, fit.schedule)
        moved = replace(start, places=target.places)
        check_apart(problem.requests, context, moved, fitted.places, pinned)
        check_poses(problem.requests, context, moved, fitted.places, pinned)


def check_forces(
    problem: MotionProblem, context: EvaluationContext, start: Motion, target: Standing
) -> None:
    """Refuses caps on forces that carry nobody with the durations of start. Raises PeakTooLow.

    context, start, target: as of `check_places`.
    """
    if not target.moves:
        check_capped(problem.requests, context, replace(start, places=target.places))


def retimed_jumps(
    problem: MotionProblem, context: EvaluationContext, start: Motion, target: FloatArray
) -> tuple[Jump, ...]:
    """The jumps whose durations are to be found for contacts at target (n_contacts, 3) m."""
    if problem.requests.solution.keep_times or start.transcription.periodic:
        return ()  # a loop lasts whole frames
    return changed_jumps(start, context.schedule, target, kept_intervals(problem, context))


def kept_intervals(problem: MotionProblem, context: EvaluationContext) -> tuple[Interval, ...]:
    """Those whose durations the artist has set."""
    timed = {timing.phase for timing in problem.requests.timings}
    kept = tuple(Interval(p.start, p.end) for p in context.phases if p.name in timed)
    return kept + tuple(Interval(hold.start, hold.end) for hold in context.timeline.holds)


def travel_at(fit: Fit, phases: Sequence[Phase], time: float) -> FloatArray:
    """(3, 3) columns forward, left, up at an instant, s. phases: the recording's, on that time."""
    index = next((i for i, p in enumerate(phases) if time <= p.end), len(phases) - 1)
    old = fit.schedule.phases[min(index, len(fit.schedule.phases) - 1)]
    return travel_axes(fit.performance, fit.schedule, old)


def _with_body(fit: Fit, problem: MotionProblem, changed: Recording) -> Motion:
    """The fit with the body and the gravity that are asked for; the fit itself where they stay."""
    change, motion = problem.requests.body, fit.motion
    t = motion.transcription
    still = (change.mass, change.gravity, change.added, change.limbs)
    if still == (None, t.character.gravity, (), ()):
        return motion
    if change not in fit.other_bodies:
        character = changed_character(t.character, change, fit.performance.recording, changed)
        points = changed_points(t.points, t.character, character)
        moment = MomentFunction(character)
        new = replace(t, character=character, points=points, moment=moment)
        made = Motion(new, reseat(motion, character), motion.places)
        fit.other_bodies.clear()  # the last one is asked for again and again, older ones are not
        fit.other_bodies[change] = made
    return fit.other_bodies[change]


def _refuse_torques(requests: Requests) -> None:
    """Reduced dynamics have no torques to limit or to weigh. Raises NeedsTorques."""
    solution = requests.solution
    for limit in requests.torques:
        raise NeedsTorques(limit.name)
    if solution.method is not Method.IMPLICIT:
        weighed = [o.value for o, weight in solution.objectives if weight > 0.0]
        weighed = weighed if solution.method is Method.EXPLICIT else [solution.method.value]
        for name in weighed:
            if name in TORQUE_OBJECTIVES:
                raise NeedsTorques(name)
