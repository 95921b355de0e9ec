"""Sets a problem up: what the fit becomes before it is solved for (thesis 6.2 to 6.4).

Other proportions or masses, retimed phases, held frames, contacts that are lifted or added: each
changes the equations, so the fit is carried over to new ones as a first guess. Where nothing of
that kind is asked for, the fit's own equations serve.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..analysis.pinned_places import pinned_places, travel_axes
from ..arrays import FloatArray
from ..body.body_changes import changed_character, changed_points
from ..body.dynamics import MomentFunction
from ..body.proportions import changed_recording
from ..data.constants import STANDARD_GRAVITY
from ..data.contacts import Contact, ContactSchedule, Phase
from ..data.faults import (
    BadTiming,
    FreePoint,
    NeedsTorques,
    NothingTouches,
    TakenName,
    UnknownPhaseIn,
)
from ..data.problem import MotionProblem
from ..data.recording import Recording
from ..data.requests import ConeShape, Dynamics, Method, ObjectiveKind, PointRequest, Requests
from ..data.timeline import MIN_PHASE_DURATION, timeline
from ..numerics.block_banded import BlockBanded
from ..numerics.splines import SplineBasis, phase_breaks
from ..optimisation.reduction import ReducedSpace, reduce
from ..transcription.contact_pins import PointContact, Track
from ..transcription.motion import Motion
from ..transcription.objectives import torque_metric
from ..transcription.torque_constraint import TorqueFunction, every_torque
from ..transcription.tracking_cost import CostWeights
from ..transcription.transcription import Transcription
from .constraint_builder import (
    EvaluationContext,
    conditions,
    path_places,
    point_axes,
    point_place,
    touches,
)
from .fit import (
    ADAPT_PRICES,
    SHORTEST_SPAN,
    SPANS,
    THIRD_DERIVATIVE_WEIGHT,
    Fit,
    body_points,
    dense_instants,
    motion_metric,
    point_contacts,
)
from .reseat import reseated

HELD_SPAN = 0.04  # s; a held frame tells nothing of the swing that physics makes of it
SAMPLES_PER_TRACK = 60.0  # Hz
OF_TORQUES = (
    ObjectiveKind.TORQUE_SMOOTHNESS.value,
    ObjectiveKind.POWER.value,
    ObjectiveKind.TORQUE_OUTPUT.value,
    ObjectiveKind.TOTAL_CHANGE.value,
    Method.IMPLICIT_TORQUES.value,
)


@dataclass(frozen=True)
class Setup:
    """A problem ready to be solved.

    start: the first guess, whose equations have the problem's conditions; its places are where
    the contacts are now. goal: (n_contacts, 3) m, where they shall be. turns: what the pins ask
    of each phase, rad. basis: (n_block, k), the changes that a reduction allows, None all.
    requests: those set up here. recording: of the figure as it is asked for. space: the reduced
    figure, None where it is not reduced.
    """

    fit: Fit
    scene: EvaluationContext
    start: Motion
    goal: FloatArray
    metric: BlockBanded
    turns: dict[str, float]
    basis: FloatArray | None
    recording: Recording
    requests: Requests
    space: ReducedSpace | None

    def metric_of(self, motion: Motion) -> BlockBanded:
        """The norm in which steps from a motion of this problem are small."""
        metric = motion_metric(motion, _prices(self.requests))
        if _weighs_torques(self.requests):
            metric.lower += torque_metric(motion, self.torques).lower
        return metric

    @property
    def schedule(self) -> ContactSchedule:
        return self.scene.schedule

    @cached_property
    def torques(self) -> TorqueFunction:
        """The torques of every joint; the fit's own function where it serves."""
        t, old = self.start.transcription, self.fit.motion.transcription
        same = t.points is old.points and t.character is old.character
        return self.fit.torques if same else every_torque(t)


def set_up(fit: Fit, problem: MotionProblem) -> Setup:
    """Sets a problem up from a fit.

    Raises UnknownPhase, UnknownContact, ContradictoryPins and the requests' own faults.
    """
    requests, recording = problem.requests, fit.performance.recording
    if requests.solution.dynamics is Dynamics.REDUCED:
        _refuse_torques(requests)
    rate = (len(recording.times) - 1) / float(recording.times[-1])
    first = float(recording.frames[0])
    line = timeline(fit.schedule, first, rate, requests.timings, requests.holds)
    changed = changed_recording(recording, requests.body.limbs)
    reference = _with_body(fit, problem, changed)
    schedule = _without_lifted(line.schedule(fit.schedule), problem)

    phases = line.schedule(fit.schedule).phases

    def travel(time: float) -> FloatArray:
        index = next((i for i, p in enumerate(phases) if time <= p.end), len(phases) - 1)
        old = fit.schedule.phases[min(index, len(fit.schedule.phases) - 1)]
        return travel_axes(fit.performance, fit.schedule, old)

    scene = EvaluationContext(changed, fit.motion, reference, phases, schedule, line, travel)
    added = {r.name: r for r in requests.points if r.environment}
    contacts = [_added(request, scene) for request in added.values()]
    scene = replace(scene, schedule=_with_added(schedule, contacts))
    start = _start(fit, problem, scene, added)
    start = _with_conditions(start, problem, scene)
    goal = goal_places(fit, problem, scene.schedule)
    same = start.transcription.basis is fit.motion.transcription.basis and reference is fit.motion
    prices = _prices(requests)
    kept = same and prices is ADAPT_PRICES
    metric = fit.metric if kept else motion_metric(start, prices)
    if _weighs_torques(requests):
        metric = metric.copy()
        metric.lower += _torque_metric(fit, start, same=same).lower
    turns = _turns(problem, phases, scene.schedule)
    reduction, space = requests.solution.reduction, None
    if reduction is not None:
        space = reduce(reduction, start.transcription.character, fit.performance.angles)
    basis = _allowed(space, start)
    return Setup(fit, scene, start, goal, metric, turns, basis, changed, requests, space)


def goal_places(fit: Fit, problem: MotionProblem, schedule: ContactSchedule) -> FloatArray:
    """(n_contacts, 3) m: where the problem's pins put the contacts of its schedule.

    Raises UnknownPhase, UnknownContact, ContradictoryPins.
    """
    places = pinned_places(problem, fit.performance, fit.schedule)
    wanted = {c.name: place for c, place in zip(fit.schedule.contacts, places, strict=True)}
    return np.array([wanted.get(c.name, c.place) for c in schedule.contacts]).reshape(-1, 3)


def _weighs_torques(requests: Requests) -> bool:
    """Whether changes of torques count in the norm of the steps."""
    solution = requests.solution
    return solution.method is not Method.IMPLICIT and solution.dynamics is not Dynamics.REDUCED


def _refuse_torques(requests: Requests) -> None:
    """Reduced dynamics have no torques to limit or to weigh. Raises NeedsTorques."""
    solution = requests.solution
    for limit in requests.torques:
        raise NeedsTorques(limit.name)
    if solution.method is not Method.IMPLICIT:
        weighed = [o.value for o, weight in solution.objectives if weight > 0.0]
        weighed = weighed if solution.method is Method.EXPLICIT else [solution.method.value]
        for name in weighed:
            if name in OF_TORQUES:
                raise NeedsTorques(name)


def _turns(
    problem: MotionProblem, named: Sequence[Phase], schedule: ContactSchedule
) -> dict[str, float]:
    """What the pins ask of the result's ground phases, rad; pins name the recording's."""
    turns: dict[str, float] = {}
    for pin in problem.pins:
        was = next((phase for phase in named if phase.name == pin.phase), None)
        for phase in schedule.phases:
            if was is not None and phase.start < was.end and phase.end > was.start:
                turns[phase.name] = turns.get(phase.name, 0.0) + pin.turn
    return turns


def _prices(requests: Requests) -> CostWeights:
    """The usual prices; forces are dearer where they shall stay like the fit's."""
    wishes = [r.match for r in requests.forces if r.match is not None]
    return replace(ADAPT_PRICES, force=max(wishes) * ADAPT_PRICES.force) if wishes else ADAPT_PRICES


def _torque_metric(fit: Fit, start: Motion, *, same: bool) -> BlockBanded:
    return fit.torque_metric if same else torque_metric(start, every_torque(start.transcription))


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
        made = Motion(new, reseated(motion, character), motion.places)
        fit.other_bodies.clear()  # the last one is asked for again and again, older ones are not
        fit.other_bodies[change] = made
    return fit.other_bodies[change]


# ---------------------------------------------------------------- contacts


def _without_lifted(schedule: ContactSchedule, problem: MotionProblem) -> ContactSchedule:
    kept = schedule.contacts
    for lift in problem.requests.lifts:
        phase = next((p for p in schedule.phases if p.name == lift.phase), None)
        if phase is None:
            known = tuple(p.name for p in schedule.phases)
            raise UnknownPhaseIn(lift.name, lift.phase, known)
        lifted = [
            c.name
            for c in kept
            if c.start < phase.end and c.end > phase.start and touches(lift.touching, c)
        ]
        if not lifted:
            raise NothingTouches(lift.name, lift.touching)
        kept = tuple(c for c in kept if c.name not in lifted)
    return replace(schedule, contacts=kept)


def _added(request: PointRequest, scene: EvaluationContext) -> Contact:
    """The contact that an environment point makes, from when it holds."""
    body = scene.body(request.name, request.bone)
    span = scene.interval(request.name, request.when)
    if span[1] - span[0] < MIN_PHASE_DURATION:
        raise BadTiming(request.name, span[1] - span[0])
    if any(request.name in (c.name, c.point) for c in scene.schedule.contacts):
        raise TakenName(request.name)
    if request.bounds is not None and (0.0, 0.0) not in request.bounds:
        raise FreePoint(request.name)
    point = scene.point(body, request.offset)
    place = point_place(request, scene, point, span)(np.array([span[0]]))[0]
    bone = scene.recording.bones[scene.recording.index(request.bone)]
    offset = bone.rotation.T @ point.place
    return Contact(request.name, request.name, request.bone, offset, *span, place)


def _with_added(schedule: ContactSchedule, added: Sequence[Contact]) -> ContactSchedule:
    contacts = sorted([*schedule.contacts, *added], key=lambda c: (c.start, c.point))
    return replace(schedule, contacts=tuple(contacts))


def _detailed(
    contact: PointContact,
    problem: MotionProblem,
    scene: EvaluationContext,
    request: PointRequest | None,
) -> PointContact:
    """A contact with its friction, and with what an environment point says of it."""
    friction, pyramid = contact.friction, False
    for force in problem.requests.forces:
        shaped = force.friction is not None or force.shape is ConeShape.PYRAMID
        if shaped and touches(force.touching, contact.contact):
            start, end = scene.interval(force.name, force.when)
            if contact.contact.start < end and contact.contact.end > start:
                friction = friction if force.friction is None else force.friction
                pyramid = force.shape is ConeShape.PYRAMID
    contact = replace(contact, friction=friction, pyramid=pyramid)
    if request is None:
        return contact
    span = (contact.contact.start, contact.contact.end)
    held, track = None, None
    if request.bounds is not None:
        axes = point_axes(request, scene, span)
        held = axes.T[[bound == (0.0, 0.0) for bound in request.bounds]]
    if request.path is not None:
        count = max(2, int((span[1] - span[0]) * SAMPLES_PER_TRACK))
        times = np.linspace(*span, count)
        places = path_places(request.path, scene.timeline)(times)
        track = Track(times, places - places[0])
    return replace(
        contact,
        held=held,
        track=track,
        friction=None if request.grip else friction,
        normal=np.array(request.normal, dtype=float),
    )


# ---------------------------------------------------------------- equations


def _start(
    fit: Fit, problem: MotionProblem, scene: EvaluationContext, added: dict[str, PointRequest]
) -> Motion:
    """The reference on the problem's own contacts, timeline and knots, without conditions."""
    reference, schedule = scene.reference, scene.schedule
    t = reference.transcription
    coarse = problem.requests.solution.longest_span
    same = scene.timeline.unchanged and coarse is None and not added
    if same and len(schedule.contacts) == len(t.contacts):
        contacts = tuple(_detailed(c, problem, scene, None) for c in t.contacts)
        return replace(reference, transcription=replace(t, contacts=contacts))
    points, which = body_points(t.character, scene.recording, schedule)
    plain, extra = point_contacts(schedule, which)
    contacts = tuple(_detailed(c, problem, scene, added.get(c.contact.name)) for c in plain)
    if coarse is None:
        basis = _mapped_basis(t.basis, scene, extra)
    else:
        basis = SplineBasis(*phase_breaks(schedule.boundaries, extra, coarse))
    new = Transcription(t.character, basis, points, contacts, t.moment)
    x = _resampled(reference, new, scene.timeline.eased)
    motion = Motion(new, x, np.zeros((len(contacts), 3)))
    return replace(motion, places=_current_places(motion, fit))


def _mapped_basis(
    old: SplineBasis, scene: EvaluationContext, extra: Sequence[float]
) -> SplineBasis:
    """The old knots at their new instants, and those that new boundaries and holds need."""
    line, boundaries = scene.timeline, scene.schedule.boundaries
    fixed = sorted({*boundaries, *extra})
    kept: list[float] = []
    held = [
        np.linspace(hold.start, hold.end, 1 + int(np.ceil((hold.end - hold.start) / HELD_SPAN)))
        for hold in line.holds
    ]
    for t in np.unique(np.concatenate([line.to_new(old.breaks), *held])).tolist():
        near = min(abs(t - other) for other in (*fixed, *kept))
        if 0.0 < t < line.duration and near > SHORTEST_SPAN:
            kept.append(t)
    return SplineBasis(*phase_breaks(boundaries, [*extra, *kept], SPANS[0]))


def _resampled(
    motion: Motion, new: Transcription, to_old: Callable[[FloatArray], FloatArray]
) -> FloatArray:
    """Unknowns of a motion on other equations: splines by least squares, forces at the nodes."""
    basis, layout, old = new.basis, new.layout, motion.transcription
    times = dense_instants(basis)
    x = np.zeros((basis.n_coefficients, layout.n_block))
    x[:, layout.com] = basis.project(times, motion.com(to_old(times)), THIRD_DERIVATIVE_WEIGHT)
    x[:, layout.angles] = basis.project(
        times, motion.angles(to_old(times)), THIRD_DERIVATIVE_WEIGHT
    )
    names = {c.point: c.contact.point for c in old.contacts}
    came_from = {name: point for point, name in names.items()}
    nodes = basis.force_nodes(np.arange(basis.n_spans))
    inside = 1e-6 * np.diff(basis.breaks)
    weight = old.character.mass * STANDARD_GRAVITY
    for side, at in enumerate((basis.breaks[:-1] + inside, basis.breaks[1:] - inside)):
        forces = motion.forces(to_old(at)) / weight
        for contact in new.contacts:
            point = came_from.get(contact.contact.point)
            if point is not None:
                x[nodes[:, side] + 1, layout.force(contact.point)] = forces[:, point]
    x[~new.active] = 0.0
    return x


def _current_places(motion: Motion, fit: Fit) -> FloatArray:
    """(n_contacts, 3) m: the fit's place of each contact; where the point is, for a new one."""
    known = {c.name: place for c, place in zip(fit.schedule.contacts, fit.places, strict=True)}
    places = []
    for contact in motion.transcription.contacts:
        if contact.contact.name in known:
            places.append(known[contact.contact.name])
        else:
            times = np.linspace(contact.pin_start, contact.pin_end, 20)
            places.append(motion.contact_points(times)[:, contact.point].mean(axis=0))
    return np.array(places).reshape(-1, 3)


def _with_conditions(start: Motion, problem: MotionProblem, scene: EvaluationContext) -> Motion:
    made = conditions(problem.requests, scene, start.transcription)
    if not made:
        return start
    return replace(start, transcription=replace(start.transcription, conditions=made))


def _allowed(space: ReducedSpace | None, start: Motion) -> FloatArray | None:
    """(n_block, k): root, centre of mass and forces as they are, the other joints reduced."""
    if space is None:
        return None
    layout, reduced = start.transcription.layout, space.basis
    kept = layout.angles.start + 3  # the root's angles
    k = reduced.shape[1]
    rest = layout.n_block - layout.angles.stop
    basis = np.zeros((layout.n_block, kept + k + rest))
    basis[:kept, :kept] = np.eye(kept)
    basis[kept : layout.angles.stop, kept : kept + k] = reduced
    basis[layout.angles.stop :, kept + k :] = np.eye(rest)
    return basis
