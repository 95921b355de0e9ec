"""Problem set-up: transcription, initial guess, targets and metric from a fit (thesis 6.2 to 6.4).

Other proportions or masses, retimed phases, held frames, contacts that are lifted or added: each
changes the transcription, so the fit is resampled on a new one as an initial guess. Where nothing
of that kind is asked for, the fit's own transcription serves.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np

from ..analysis.pinned_places import pinned_by, travel_axes
from ..analysis.timeline import TimeWarp, timeline
from ..arrays import FloatArray
from ..body.body_changes import changed_character, changed_points
from ..body.dynamics import MomentFunction
from ..body.proportions import changed_recording
from ..constraints.capped_forces import check_capped
from ..constraints.constraint_builder import build_constraints
from ..constraints.contact_setup import added_contact, with_added, without_lifted
from ..constraints.evaluation_context import EvaluationContext
from ..constraints.far_apart import check_apart
from ..constraints.held_pose import check_poses
from ..data.contacts import ContactSchedule, Interval, Phase
from ..data.faults import NeedsTorques
from ..data.problem import MotionProblem
from ..data.recording import Recording
from ..data.requests import AngleLimit, ConeLimit, Requests, TwistLimit
from ..data.scene import SceneObject
from ..data.solver_options import Dynamics, HumanRanges, Method, ObjectiveKind
from ..data.status import Durations
from ..fitting.fit import ADAPT_COST_WEIGHTS, Fit, LinearisedPoses
from ..human.human_guard import HumanGuard, recorded_ranges
from ..human.range_price import range_price
from ..inverse_kinematics.reseat import reseat
from ..numerics.block_banded import BlockBanded
from ..objectives.joint_price import JointPrice
from ..objectives.least_squares import torque_metric
from ..objectives.motion_metric import motion_metric
from ..objectives.tracking_cost import CostWeights
from ..optimisation.guards import Guard
from ..optimisation.reduction import ReducedSpace, reduce
from ..optimisation.sqp import FeasibleSet
from ..solid.flesh import shape_flesh
from ..solid.room import check_room
from ..solid.shape_changes import ShapeChanges
from ..solid.solid_world import SolidWorld
from ..transcription.motion import Motion
from ..transcription.torque_constraint import TorqueFunction, joint_torques
from ..transcription.transcription import Transcription
from .anticipation import Jump, anticipate, changed_jumps
from .footing import check_sunk, on_faces, pin_turns
from .initial_guess import resampled_fit
from .platforms import find_standing, recorded_in
from .surroundings import surroundings
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


@dataclass(frozen=True)
class Setup:
    """A problem ready to be solved.

    start: the initial guess, whose transcription has the problem's constraints; its places are
    where its contacts are, on still ground. fitted: where they were in the
    fit; target: where they shall be, and the rides from there, which the transcription has.
    metric: W at the start. turns: of the ground phases by the pins, rad. basis: (n_block, k), the
    changes of a block that a reduction allows, None all. requests: those set up here. recording: of
    the figure as it is asked for. space: the reduced coordinates, None where there are none.
    durations: where they come from. changes: of the solid shapes. scene: what is around. price: of
    turning joints, which is in the metric; None for a figure that is no human.
    """

    fit: Fit
    context: EvaluationContext
    start: Motion
    fitted: Standing
    target: Standing
    metric: BlockBanded
    turns: dict[str, float]
    basis: FloatArray | None
    recording: Recording
    requests: Requests
    space: ReducedSpace | None
    durations: Durations
    changes: ShapeChanges
    scene: tuple[SceneObject, ...] = ()
    price: JointPrice | None = None

    def feasible_set(
        self, transcription: Transcription, places: FloatArray | None = None
    ) -> FeasibleSet:
        """Feasible set of a transcription; places (n_contacts, 3) m, None the target's."""
        places = self.target_places if places is None else places
        return FeasibleSet(transcription, places, self.basis)

    def metric_of(self, motion: Motion) -> BlockBanded:
        """Metric W of the minimum-norm steps from a motion of this problem."""
        metric = motion_metric(motion, _cost_weights(self.requests), self.price)
        if _weighs_torques(self.requests):
            metric.lower += torque_metric(motion, self.torques).lower
        return metric

    @property
    def target_places(self) -> FloatArray:
        """(n_contacts, 3) m."""
        return self.target.places

    @property
    def schedule(self) -> ContactSchedule:
        return self.context.schedule

    @cached_property
    def solid(self) -> SolidWorld | None:
        """What is solid; None where limbs and floor may go through each other."""
        if not self.requests.solution.solid:
            return None
        lowest, clears = self.target.lowest(self.schedule), self.requests.clears
        return surroundings(self.fit, self.context, lowest, self.scene, clears, self.changes)

    @cached_property
    def human(self) -> HumanGuard | None:
        """How far joints may go; None for a figure that is no human.

        Joints that the artist limits, or says are none of a person's, are the artist's alone.
        """
        asked, solution = self.requests, self.requests.solution
        if not solution.human:
            return None
        limits: tuple[AngleLimit | ConeLimit | TwistLimit, ...]
        limits = (*asked.angles, *asked.cones, *asked.twists)
        own = {limit.bone for limit in limits}
        own |= {bone for shape in asked.shapes if not shape.human for bone in shape.bones}
        reference, hard = self.context.reference, solution.human is HumanRanges.HARD
        ranges = tuple(each.widened(solution.wider) for each in recorded_ranges(reference))
        return HumanGuard(ranges, reference, frozenset(own), hard)

    @cached_property
    def guards(self) -> tuple[Guard, ...]:
        """What the motion must not do though nobody asks."""
        return tuple(guard for guard in (self.solid, self.human) if guard is not None)

    @cached_property
    def sparse_guards(self) -> tuple[Guard, ...]:
        """The same, as a drag looks at them."""
        return tuple(guard.sparse() for guard in self.guards)

    @cached_property
    def torques(self) -> TorqueFunction:
        """Torque function of every joint."""
        return joint_torques(self.start.transcription)


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
        partial(_travel, fit, retimed.phases),
    )
    added = {r.name: r for r in requests.points if r.environment}
    contacts = [added_contact(request, context) for request in added.values()]
    context = replace(context, schedule=with_added(context.schedule, contacts))
    start = resampled_fit(fit, problem, context, added)
    fitted = Standing(start.places, recorded_in(fit, context))
    target, footing = find_standing(fit, problem, context)
    flesh = shape_flesh(problem, fit.performance)
    changes = ShapeChanges.of(requests.shapes, context.character, flesh)
    if requests.solution.solid:
        check_sunk(problem.scene, context.schedule, footing)
        if requests.solution.human:
            check_room(
                problem.scene, reference.transcription, context.schedule, target.places, changes
            )
    return Requested(context, on_faces(start, footing), fitted, target, reference, changed, changes)


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


def set_up(fit: Fit, problem: MotionProblem) -> Setup:
    """Problem set-up from a fit.

    Raises UnknownPhase, UnknownContact, ContradictoryPins and the requests' own faults.
    """
    asked, requests = requested(fit, problem), problem.requests
    context, start, target, reference = asked.context, asked.start, asked.target, asked.reference
    durations, price = Durations.MOVING_GROUND, _price(fit, reference, requests)
    if not target.moves:  # the ground's clock is no jumper's to stretch
        context, start, durations = _anticipated(fit, problem, context, start, target.places, price)
    start = _with_constraints(_riding(start, asked.fitted, target), problem, context)
    same = start.transcription.basis is fit.motion.transcription.basis and reference is fit.motion
    weights = _cost_weights(requests)
    kept = same and weights is ADAPT_COST_WEIGHTS and price is not None
    metric = fit.metric if kept else motion_metric(start, weights, price)
    if _weighs_torques(requests):
        metric = metric.copy()
        metric.lower += _torque_metric(fit, start, same=same).lower
    turns = pin_turns(problem, context.phases, context.schedule)
    reduction, space = requests.solution.reduction, None
    if reduction is not None:
        space = reduce(reduction, start.transcription.character, fit.performance.angles)
    basis = _reduced_basis(space, start)
    return Setup(
        fit,
        context,
        start,
        asked.fitted,
        target,
        metric,
        turns,
        basis,
        asked.recording,
        requests,
        space,
        durations,
        asked.changes,
        problem.scene,
        price,
    )


def _anticipated(
    fit: Fit,
    problem: MotionProblem,
    context: EvaluationContext,
    start: Motion,
    target: FloatArray,
    price: JointPrice | None,
) -> tuple[EvaluationContext, Motion, Durations]:
    """Context and initial guess with the durations that go with where the contacts shall be."""
    jumps = retimed_jumps(problem, context, start, target)
    if not jumps:
        return context, start, Durations.RECORDED
    own = start is fit.motion and price is fit.price
    poses = fit.poses if own else LinearisedPoses(start, price)
    kept = _kept_intervals(problem, context)
    found = anticipate(poses, context.schedule, target, kept, jumps)
    if found is None:
        return context, start, Durations.NONE_FOUND
    warp = TimeWarp.of(found.stretches, start.duration)
    phases = tuple(
        replace(p, start=float(warp(p.start)), end=float(warp(p.end))) for p in context.phases
    )
    context = replace(
        context,
        phases=phases,
        schedule=warp.schedule(context.schedule),
        timeline=context.timeline.warped(warp),
        travel=partial(_travel, fit, phases),
    )
    return context, found.motion, Durations.FOUND


def retimed_jumps(
    problem: MotionProblem, context: EvaluationContext, start: Motion, target: FloatArray
) -> tuple[Jump, ...]:
    """The jumps whose durations are to be found for contacts at target (n_contacts, 3) m."""
    if problem.requests.solution.keep_times or start.transcription.periodic:
        return ()  # a loop lasts whole frames
    return changed_jumps(start, context.schedule, target, _kept_intervals(problem, context))


def _kept_intervals(problem: MotionProblem, context: EvaluationContext) -> tuple[Interval, ...]:
    """Those whose durations the artist has set."""
    timed = {timing.phase for timing in problem.requests.timings}
    kept = tuple(Interval(p.start, p.end) for p in context.phases if p.name in timed)
    return kept + tuple(Interval(hold.start, hold.end) for hold in context.timeline.holds)


def _riding(start: Motion, fitted: Standing, target: Standing) -> Motion:
    """The initial guess with contacts that ride on what the target has them stand on."""
    t, moves = start.transcription, fitted.moves or target.moves
    return replace(start, transcription=t.riding(target.rides)) if moves else start


def _weighs_torques(requests: Requests) -> bool:
    """Whether changes of torques count in the metric of the steps: (q, tau, lambda), thesis 4.4."""
    solution = requests.solution
    return solution.method is not Method.IMPLICIT and solution.dynamics is not Dynamics.REDUCED


def _cost_weights(requests: Requests) -> CostWeights:
    """Default cost weights; the force weight scaled by the largest `match` of the requests."""
    matches = [r.match for r in requests.forces if r.match is not None]
    if not matches:
        return ADAPT_COST_WEIGHTS
    return replace(ADAPT_COST_WEIGHTS, force=max(matches) * ADAPT_COST_WEIGHTS.force)


def _price(fit: Fit, reference: Motion, requests: Requests) -> JointPrice | None:
    """What turning joints costs; nothing where the figure is no human. reference: see Setup."""
    if not requests.solution.human:
        return None
    return fit.price if reference is fit.motion else range_price(reference)


def _torque_metric(fit: Fit, start: Motion, *, same: bool) -> BlockBanded:
    return fit.torque_metric if same else torque_metric(start, joint_torques(start.transcription))


def _with_constraints(start: Motion, problem: MotionProblem, context: EvaluationContext) -> Motion:
    made = build_constraints(problem.requests, context, start.transcription)
    if not made:
        return start
    return replace(start, transcription=replace(start.transcription, constraints=made))


def _reduced_basis(space: ReducedSpace | None, start: Motion) -> FloatArray | None:
    """Basis (n_block, k): root, centre of mass and forces in full, other joints reduced."""
    if space is None:
        return None
    layout, reduced = start.transcription.layout, space.basis
    kept, rest = layout.root_angles.stop, layout.n_block - layout.n_motion
    k = reduced.shape[1]
    basis = np.zeros((layout.n_block, kept + k + rest))
    basis[:kept, :kept] = np.eye(kept)
    basis[layout.joint_angles, kept : kept + k] = reduced
    basis[layout.forces, kept + k :] = np.eye(rest)
    return basis


def _travel(fit: Fit, phases: Sequence[Phase], time: float) -> FloatArray:
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
