"""The fit: the physically valid motion nearest to the recording (thesis 4.2).

It is computed once per recording and starts every adaptation.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..analysis.accelerations import angle_accelerations, com_acceleration, velocities
from ..analysis.performance import Performance
from ..arrays import FloatArray, IntArray
from ..body.character import Character
from ..body.dynamics import MomentFunction
from ..body.kinematics import BodyPoint, forward_kinematics
from ..data.constants import STANDARD_GRAVITY
from ..data.contacts import ContactSchedule
from ..data.recording import Recording
from ..data.requests import BodyChange
from ..data.status import Status
from ..numerics.block_banded import BlockBanded
from ..numerics.interpolation import interpolate
from ..numerics.splines import SplineBasis, gauss_instants, phase_breaks
from ..objectives.cost_to_go import EndTarget
from ..objectives.least_squares import torque_metric
from ..objectives.tracking_cost import CostWeights, TrackingCost, TrackingTarget, marker_points
from ..optimisation.gauss_newton import minimise
from ..optimisation.sqp import FeasibleSet, Outcome, Progress, project, restore
from ..transcription.compliant_sole import sole_trajectory
from ..transcription.contact_pins import PointContact, touching_spans
from ..transcription.motion import (
    DenseTolerance,
    Motion,
    pinned_instants,
    spans_to_refine,
    split_spans,
)
from ..transcription.torque_constraint import TorqueFunction, joint_torques
from ..transcription.transcription import Transcription

CANDIDATE_SPANS = (0.04, 0.03, 0.025)  # s, longest knot spans to choose from
SPLINE_FIT_TOLERANCE = 0.004  # m, rms spline-fit error of a joint centre
MIN_SPAN = 0.015  # s, between breaks
# One g of the centre of mass's acceleration weighs like a decimetre: recordings are off by a tenth
# of g and by a centimetre. A body weight of force across the recorded direction weighs like 3 cm.
# Set beside force plates (docs/validation.md).
FIT_COST_WEIGHTS = CostWeights(
    position=1.0,
    acceleration_time=0.05,
    com_acceleration=1e-2,
    force=1e-5,
    force_rate_time=0.15,
    friction=1e-3,
    goes_on=True,
)
# An adaptation keeps the shape; where the centre of mass goes is for physics to say. Forces
# weigh too: what a person does to jump further is push longer, not only harder.
ADAPT_COST_WEIGHTS = CostWeights(shape=1.0, com=0.02, acceleration_time=0.1, force=3e-3)
MAX_REFINEMENTS = 3
MAX_PLACE_UPDATES = 4
MAX_PROJECTION_STEPS = 6
MAX_IMPROVEMENTS = 4  # Gauss-Newton steps on the refined knots
EDGE_SPAN = 0.02  # s; the span before a landing and after a lift-off, in which feet stop and start
MIN_LOAD = 0.25  # of the weight, with which the direction of the contact force is known
MAX_SLOPE = 0.5  # of that direction; runners and jumpers on force plates use 0.25 to 0.6
THIRD_DERIVATIVE_WEIGHT = 1e-9  # regularises splines through samples that jump between contacts
# The fit is made finer than an adaptation needs, so that most adaptations need no more knots.
FIT_TOLERANCE = DenseTolerance(flight=4e-4, ground=1.5e-3, drift=1e-4)
ADAPT_TOLERANCE = DenseTolerance(flight=1e-3, ground=4e-3, drift=4e-4)


@dataclass(frozen=True)
class SolvedMotion:
    """A solved motion: the outcomes of its stages in order, and each contact's place."""

    outcomes: tuple[Outcome, ...]
    places: FloatArray  # (n_contacts, 3) m

    @property
    def outcome(self) -> Outcome:
        return self.outcomes[-1]

    @cached_property
    def motion(self) -> Motion:
        return Motion(self.outcome.transcription, self.outcome.x, self.places)

    @property
    def solved(self) -> bool:
        return self.outcome.status is Status.SOLVED


@dataclass(frozen=True)
class Fit(SolvedMotion):
    """A fitted performance."""

    performance: Performance
    schedule: ContactSchedule

    @cached_property
    def metric(self) -> BlockBanded:
        """Metric W of the minimum-norm steps of its adaptations."""
        return motion_metric(self.motion, ADAPT_COST_WEIGHTS)

    @cached_property
    def other_bodies(self) -> dict[BodyChange, Motion]:
        """Cache of the fit with other bodies (setup.py): their functions take long to build."""
        return {}

    @cached_property
    def torques(self) -> TorqueFunction:
        """Torque function of every joint."""
        return joint_torques(self.motion.transcription)

    @cached_property
    def torque_metric(self) -> BlockBanded:
        """Metric of changes of the fit's torques; see objectives.torque_metric."""
        return torque_metric(self.motion, self.torques)


def fit(
    performance: Performance,
    schedule: ContactSchedule,
    *,
    progress: Progress | None = None,
) -> Fit:
    """The physically valid motion nearest to the recording, with its contacts (thesis 4.2).

    A fit that fails is returned as it ended, with a status that says so.
    """
    transcription = transcribe(performance, schedule)
    x = initial_guess(transcription, performance)
    places = np.array([c.contact.place for c in transcription.contacts]).reshape(-1, 3)
    tracking_cost = TrackingCost(
        transcription, recorded_target(transcription, performance, schedule), FIT_COST_WEIGHTS
    )
    feasible = FeasibleSet(transcription, places)
    near = project(
        feasible, tracking_cost, x, stage="fit", max_steps=MAX_PROJECTION_STEPS, progress=progress
    )
    metric = tracking_cost.expand(near.x)[1]
    outcomes, last = [near], near
    for _ in range(1 + MAX_PLACE_UPDATES):
        last = restore(feasible, metric, last.x, stage="fit", progress=progress)
        outcomes.append(last)
        if last.status is Status.SOLVED:
            outcomes += refine(last, fit_metric, FIT_TOLERANCE, progress=progress)
            outcomes += _improved(outcomes[-1], performance, schedule, progress)
            break
        places = reached_places(Motion(last.transcription, last.x, places))
        feasible = replace(feasible, places=places)
    settled = tuple(
        replace(contact, place=place)
        for contact, place in zip(schedule.contacts, places, strict=True)
    )
    return Fit(tuple(outcomes), places, performance, replace(schedule, contacts=settled))


def _improved(
    outcome: Outcome,
    performance: Performance,
    schedule: ContactSchedule,
    progress: Progress | None,
) -> list[Outcome]:
    """Nearer to the recording on the refined knots: the steps that refine go the shortest way."""
    t = outcome.transcription
    feasible = FeasibleSet(t, outcome.places)
    cost = TrackingCost(t, recorded_target(t, performance, schedule), FIT_COST_WEIGHTS)
    nearer = minimise(
        feasible, cost, outcome.x, stage="fit", max_steps=MAX_IMPROVEMENTS, progress=progress
    )
    metric = cost.expand(nearer.x)[1]
    restored = restore(feasible, metric, nearer.x, stage="fit", progress=progress)
    if not restored.solved:
        return []
    return [nearer, restored, *refine(restored, fit_metric, ADAPT_TOLERANCE, progress=progress)]


def reached_places(motion: Motion) -> FloatArray:
    """(n_contacts, 3) m, mean position of each pinned point.

    Places read off a recording contradict each other by millimetres where heel and toe of one foot
    are both down; where the steps brought them they agree better.
    """
    places = motion.places.copy()
    for i, contact in enumerate(motion.transcription.contacts):
        instants = pinned_instants(contact, 120.0)
        places[i] = motion.contact_points(instants)[:, contact.point].mean(axis=0)
    return places


def refine(
    outcome: Outcome,
    metric_of: Callable[[Motion], BlockBanded],
    tolerance: DenseTolerance,
    *,
    basis: FloatArray | None = None,
    progress: Progress | None = None,
) -> list[Outcome]:
    """Knot refinement: splits spans until dynamics and pins hold between the nodes (thesis 6.4).

    basis: the changes of a block that are allowed, see FeasibleSet.
    """
    outcomes: list[Outcome] = []
    for _ in range(MAX_REFINEMENTS):
        motion = Motion(outcome.transcription, outcome.x, outcome.places)
        weak = spans_to_refine(motion, tolerance)
        if not len(weak):
            break
        finer = on_finer_basis(motion, weak)
        metric = metric_of(finer)
        feasible = FeasibleSet(finer.transcription, outcome.places, basis)
        finer_outcome = restore(feasible, metric, finer.x, stage="refine", progress=progress)
        if finer_outcome.status is not Status.SOLVED:
            break  # what was solved for stands; its residual between the nodes is reported
        outcome = finer_outcome
        outcomes.append(outcome)
    return outcomes


def on_finer_basis(motion: Motion, spans: IntArray) -> Motion:
    """Knot insertion: the same motion with some spans split in two."""
    old = motion.transcription
    breaks = split_spans(old.basis.breaks, spans)
    double = np.isin(breaks, old.basis.breaks[old.basis.double])
    basis = SplineBasis(breaks, double)
    new = replace(old, basis=basis)
    x = np.zeros((basis.n_coefficients, old.layout.n_block))
    x[:, old.layout.motion] = old.basis.insert_knots(basis, motion.x[:, old.layout.motion])
    inner = np.arange(basis.n_spans)
    nodes = basis.force_nodes(inner)
    middles = 0.5 * (breaks[:-1] + breaks[1:])
    was = old.basis.spans(middles)
    values = motion.x[old.layout.force_block(old.basis.force_nodes(was))][:, :, old.layout.forces]
    for side in range(2):
        weights = old.basis.force_weights(breaks[inner + side], was)
        x[old.layout.force_block(nodes[:, side]), old.layout.forces] = np.einsum(
            "tk,tkn->tn", weights, values
        )
    x[~new.active] = 0.0
    return Motion(new, x, motion.places)


def fit_metric(motion: Motion) -> BlockBanded:
    """Metric W of the minimum-norm steps of a fit."""
    return motion_metric(motion, FIT_COST_WEIGHTS)


def motion_metric(motion: Motion, weights: CostWeights) -> BlockBanded:
    """Metric W at a motion: Gauss-Newton Hessian of the tracking cost to itself."""
    return TrackingCost(motion.transcription, motion_target(motion), weights).expand(motion.x)[1]


def motion_target(motion: Motion) -> TrackingTarget:
    """A motion as a tracking target."""
    t = motion.transcription
    com = t.basis.combine(motion.x[:, t.layout.com], t.node_times)
    q, a = (t.angles_at_nodes(motion.x, k) for k in (0, 2))
    markers = forward_kinematics(t.character, q).points(marker_points(t.character)) + com[:, None]
    com_acceleration = t.basis.combine(motion.x[:, t.layout.com], t.node_times, 2)
    level = np.zeros((t.basis.n_coefficients, 2))
    forces = motion.x[:, t.layout.forces]
    return TrackingTarget(markers, com, a, com_acceleration, forces, level, _ends(motion))


def _ends(motion: Motion) -> EndTarget:
    """A motion's first and last instant as a target."""
    t = motion.transcription
    times, points = t.basis.breaks[[0, -1]], marker_points(t.character)
    value, rate = (t.basis.combine(motion.x[:, t.layout.motion], times, k) for k in (0, 1))
    relative = forward_kinematics(t.character, value[:, t.layout.angles]).points(points)
    com = t.layout.com
    return EndTarget(relative + value[:, None, com], rate[:, com], rate[:, t.layout.angles])


def transcribe(performance: Performance, schedule: ContactSchedule) -> Transcription:
    """Transcription of a performance with its contacts."""
    character = performance.character
    points, which = body_points(character, performance.recording, schedule)
    contacts, extra = point_contacts(schedule, which)
    return Transcription(
        character,
        _coarsest_basis(performance, schedule.jumps, [*schedule.boundaries, *extra]),
        points,
        contacts,
        MomentFunction(character),
    )


def point_contacts(
    schedule: ContactSchedule, which: Sequence[int]
) -> tuple[tuple[PointContact, ...], list[float]]:
    """Contacts in the equations, and instants, s, shortly before landings and after lift-offs.

    which: each contact's index of a touching point.
    """
    contacts = tuple(
        PointContact(contact, point, sole=sole_trajectory(contact))
        for contact, point in zip(schedule.contacts, which, strict=True)
    )
    edges: list[float] = []
    for contact in schedule.contacts:
        for t in (contact.start - EDGE_SPAN, contact.end + EDGE_SPAN):
            near = min(abs(t - other) for other in (*schedule.boundaries, *edges))
            if 0.0 < t < schedule.duration and near > MIN_SPAN:
                edges.append(t)
    return contacts, edges


def _coarsest_basis(
    performance: Performance, jumps: Sequence[float], extra: Sequence[float]
) -> SplineBasis:
    """Basis with the fewest knots that follows the recording; `refine` adds more for physics."""
    for longest in CANDIDATE_SPANS:
        basis = SplineBasis(*phase_breaks(jumps, extra, longest))
        angles = recorded_spline(basis, performance, performance.angles)
        posed = forward_kinematics(performance.character, basis.combine(angles, performance.times))
        off = posed.centres - forward_kinematics(performance.character, performance.angles).centres
        if np.sqrt((off**2).sum(axis=2).mean(axis=0)).max() < SPLINE_FIT_TOLERANCE:
            break
    return basis


def body_points(
    character: Character, recording: Recording, schedule: ContactSchedule
) -> tuple[tuple[BodyPoint, ...], list[int]]:
    """Distinct touching points, in their bodies' frames, and each contact's index of one."""
    bodies = {body.bone: i for i, body in enumerate(character.bodies)}
    names: list[str] = []
    points: list[BodyPoint] = []
    which = []
    for contact in schedule.contacts:
        if contact.point not in names:
            bone = recording.bones[recording.index(contact.bone)]
            names.append(contact.point)
            points.append(BodyPoint(bodies[contact.bone], bone.rotation @ contact.offset))
        which.append(names.index(contact.point))
    return tuple(points), which


def initial_guess(transcription: Transcription, performance: Performance) -> FloatArray:
    """Initial guess x (K, n_block): splines of the recording, forces that explain its load."""
    basis, layout = transcription.basis, transcription.layout
    x = np.zeros((basis.n_coefficients, layout.n_block))
    x[:, layout.com] = recorded_spline(basis, performance, performance.com)
    x[:, layout.angles] = recorded_spline(basis, performance, performance.angles)
    spans = np.arange(basis.n_spans)
    middles = 0.5 * (basis.breaks[:-1] + basis.breaks[1:])
    load = basis.combine(x[:, layout.com], middles, 2)[:, 2] / STANDARD_GRAVITY + 1.0
    blocks = layout.force_block(basis.force_nodes(spans))
    for contact in transcription.contacts:
        inside = touching_spans(basis, contact.contact)
        for side in range(2):
            at = blocks[inside, side]
            x[at, layout.vertical_force(contact.point)] = np.clip(load[inside], 0.0, 4.0)
    vertical = layout.vertical_forces
    together = np.maximum((x[:, vertical] > 0).sum(axis=1, keepdims=True), 1)
    x[:, vertical] /= together
    x[~transcription.active] = 0.0
    return x


def recorded_spline(
    basis: SplineBasis, performance: Performance, samples: FloatArray
) -> FloatArray:
    """(n_coefficients, n) least-squares spline of samples (T, n) at the recording's frames.

    Fitted between the frames too: a short span may hold no frame, and a spline that nothing holds
    there would swing.
    """
    times = np.union1d(dense_instants(basis), performance.times)
    return basis.project(
        times, interpolate(performance.times, samples, times), THIRD_DERIVATIVE_WEIGHT
    )


def recorded_target(
    transcription: Transcription, performance: Performance, schedule: ContactSchedule
) -> TrackingTarget:
    """The recording as a tracking target; its forces are small and as its acceleration directs."""
    times, basis = transcription.node_times, transcription.basis
    instants = np.zeros(basis.n_coefficients)
    spans = np.arange(basis.n_spans)
    blocks = transcription.layout.force_block(basis.force_nodes(spans))
    instants[blocks] = np.stack([basis.breaks[:-1], basis.breaks[1:]], axis=1)
    load = com_acceleration(performance, schedule, instants) / STANDARD_GRAVITY
    load[:, 2] += performance.character.gravity / STANDARD_GRAVITY
    ends = basis.breaks[[0, -1]]
    markers = marker_points(performance.character)
    return TrackingTarget(
        markers=performance.points(markers, times),
        com=interpolate(performance.times, performance.com, times),
        accelerations=angle_accelerations(performance, times),
        com_acceleration=com_acceleration(performance, schedule, times),
        forces=np.zeros((basis.n_coefficients, 3 * transcription.layout.n_points)),
        slope=np.clip(load[:, :2] / np.maximum(load[:, 2:], MIN_LOAD), -MAX_SLOPE, MAX_SLOPE),
        ends=EndTarget(performance.points(markers, ends), *velocities(performance, ends)),
    )


def greville_abscissae(basis: SplineBasis) -> FloatArray:
    """(n_coefficients,) Greville abscissae, s: the instant that each coefficient stands for."""
    k = basis.knots
    return np.asarray((k[1:-3] + k[2:-2] + k[3:-1]) / 3.0)


def dense_instants(basis: SplineBasis, per_span: int = 4) -> FloatArray:
    """Gauss instants, s, that determine a spline on this basis."""
    return gauss_instants(basis.breaks, per_span)[0]
