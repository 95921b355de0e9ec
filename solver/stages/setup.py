"""Problem set-up: transcription, initial guess, targets and metric from a fit (thesis 6.2 to 6.4).

Other proportions or masses, retimed phases, held frames, contacts that are lifted or added: each
changes the transcription, so the fit is resampled on a new one as an initial guess. Where nothing
of that kind is asked for, the fit's own transcription serves.
"""

from collections.abc import Collection
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np

from ..analysis.timeline import TimeWarp
from ..arrays import BoolArray, FloatArray
from ..constraints.constraint_builder import build_constraints
from ..constraints.evaluation_context import EvaluationContext
from ..data.contacts import ContactSchedule, Interval
from ..data.loop import LEAST_TRAVEL
from ..data.problem import MotionProblem
from ..data.recording import Recording
from ..data.requests import AngleLimit, ConeLimit, Requests, TwistLimit
from ..data.scene import SceneObject
from ..data.solver_options import Dynamics, HumanRanges, Method
from ..data.status import Durations
from ..fitting.fit import ADAPT_COST_WEIGHTS, Fit, LinearisedPoses
from ..human.human_guard import HumanGuard, recorded_ranges
from ..human.range_price import range_price
from ..numerics.block_banded import BlockBanded
from ..objectives.joint_price import JointPrice
from ..objectives.least_squares import torque_metric
from ..objectives.motion_metric import motion_metric
from ..objectives.tracking_cost import CostWeights
from ..optimisation.guards import Guard
from ..optimisation.reduction import ReducedSpace, reduce
from ..optimisation.sqp import FeasibleSet
from ..solid.shape_changes import ShapeChanges
from ..solid.solid_world import SolidWorld
from ..transcription.motion import Motion
from ..transcription.torque_constraint import TorqueFunction, joint_torques
from ..transcription.transcription import Transcription
from .anticipation import anticipate
from .footing import pin_turns
from .requested import kept_intervals, requested, retimed_jumps, travel_at
from .surroundings import surroundings
from .warm_start import Standing, resting, seats


@dataclass(frozen=True)
class Setup:
    """A problem ready to be solved.

    start: the initial guess, whose transcription has the problem's constraints; its places are
    where its contacts are, on still ground. fitted: where they were in the
    fit; target: where they shall be, and the rides from there, which the transcription has.
    metric: W at the start. turns: of the contacts by the pins, rad. basis: (n_block, k), the
    changes of a block that a reduction allows, None all. requests: those set up here. recording: of
    the figure as it is asked for. space: the reduced coordinates, None where there are none.
    durations: where they come from. changes: of the solid shapes. scene: what is around. price: of
    turning joints, which is in the metric; None for a figure that is no human. seats: the stances
    in which the body rests on something that stays.
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
    seats: tuple[Interval, ...] = ()

    def feasible_set(
        self, transcription: Transcription, places: FloatArray | None = None
    ) -> FeasibleSet:
        """Feasible set of a transcription; places (n_contacts, 3) m, None the target's."""
        places = self.target_places if places is None else places
        return FeasibleSet(transcription, places, self.basis)

    def metric_of(self, motion: Motion, seated: tuple[Interval, ...] | None = None) -> BlockBanded:
        """Metric W of the minimum-norm steps from a motion of this problem. seated: other seats
        than its own."""
        seated = self.seats if seated is None else seated
        rests = _resting(motion, self.schedule, seated, self.requests)
        metric = motion_metric(motion, _cost_weights(self.requests), self.price, rests)
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


def set_up(fit: Fit, problem: MotionProblem) -> Setup:
    """Problem set-up from a fit.

    Raises UnknownPhase, UnknownContact, ContradictoryPins and the requests' own faults.
    """
    asked, requests = requested(fit, problem), problem.requests
    context, start, target, reference = asked.context, asked.start, asked.target, asked.reference
    durations, price = Durations.MOVING_GROUND, _price(fit, reference, requests)
    if not target.moves:  # the ground's clock is no jumper's to stretch
        context, start, durations = _anticipated(fit, problem, context, start, target.places, price)
    start = _on_course(_riding(start, asked.fitted, target), fit.motion)
    start = _with_constraints(start, problem, context)
    same = start.transcription.basis is fit.motion.transcription.basis and reference is fit.motion
    weights = _cost_weights(requests)
    seated = seats(context.schedule, asked.fitted, target)
    rests = _resting(start, context.schedule, seated, requests)
    kept = same and weights is ADAPT_COST_WEIGHTS and price is not None and not rests.any()
    metric = fit.metric if kept else motion_metric(start, weights, price, rests)
    if _weighs_torques(requests):
        metric = metric.copy()
        metric.lower += _torque_metric(fit, start, same=same).lower
    turns = pin_turns(problem.pins, fit.schedule)
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
        seated,
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
    kept = kept_intervals(problem, context)
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
        travel=partial(travel_at, fit, phases),
    )
    return context, found.motion, Durations.FOUND


def _riding(start: Motion, fitted: Standing, target: Standing) -> Motion:
    """The initial guess with contacts that ride on what the target has them stand on."""
    t, moves = start.transcription, fitted.moves or target.moves
    return replace(start, transcription=t.riding(target.rides)) if moves else start


def _on_course(start: Motion, fitted: Motion) -> Motion:
    """The initial guess of a motion that repeats, which goes where the fit does: a stance that is
    moved is so in every cycle, but to turn all of them takes less change than to place one foot
    elsewhere each time."""
    travel = np.diff(fitted.com(np.array([0.0, fitted.duration])), axis=0)[0, :2]
    length = float(np.linalg.norm(travel))
    if not start.transcription.periodic or length < LEAST_TRAVEL:
        return start
    x, y = (travel / length).tolist()
    return replace(start, transcription=replace(start.transcription, course=(x, y)))


def _weighs_torques(requests: Requests) -> bool:
    """Whether changes of torques count in the metric of the steps: (q, tau, lambda), thesis 4.4."""
    solution = requests.solution
    return solution.method is not Method.IMPLICIT and solution.dynamics is not Dynamics.REDUCED


def _resting(
    motion: Motion,
    schedule: ContactSchedule,
    seated: Collection[Interval],
    requests: Requests,
) -> BoolArray:
    """(N,) the dynamics nodes of a motion at which the pelvis is kept where it rests; none where
    the artist says where it shall be."""
    t = motion.transcription
    asked = {p.bone for p in requests.points} | {o.bone for o in requests.orientations}
    if t.character.bodies[0].bone in asked:
        seated = ()
    return resting(schedule, seated, t.node_times)


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
