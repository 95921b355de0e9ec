"""The fit: the physically valid motion nearest to the recording (thesis 4.2).

It is computed once per recording and starts every adaptation.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..analysis.performance import Performance
from ..arrays import FloatArray, IntArray
from ..body.character import Character
from ..body.dynamics import MomentFunction
from ..body.kinematics import BodyPoint, forward_kinematics
from ..data.constants import STANDARD_GRAVITY
from ..data.contacts import Contact, ContactSchedule
from ..data.recording import Recording
from ..data.requests import BodyChange
from ..data.status import Status
from ..numerics.block_banded import BlockBanded
from ..numerics.interpolation import interpolate
from ..numerics.splines import SplineBasis, gauss_instants, phase_breaks
from ..optimisation.sqp import Outcome, Progress, project, restore
from ..transcription.contact_pins import PointContact
from ..transcription.motion import DenseTolerance, Motion, pinned_instants, split, weak_spans
from ..transcription.objectives import torque_metric
from ..transcription.torque_constraint import TorqueFunction, every_torque
from ..transcription.tracking_cost import CostWeights, Target, TrackingCost, marker_points
from ..transcription.transcription import SETTLE, Transcription, touching_spans

SPANS = (0.08, 0.06, 0.045, 0.035, 0.025)  # s, from which the clip chooses
SPLINE_FIT_TOLERANCE = 0.004  # m; how far a joint may be, rms, from the recording for want of knots
SHORTEST_SPAN = 0.015  # s
FIT_PRICES = CostWeights(place=1.0, smooth_s=0.05, force=1e-4)
# An adaptation keeps the shape; where the centre of mass goes is for physics to say. Forces are
# priced too: what a person does to jump further is push longer, not only harder.
ADAPT_PRICES = CostWeights(shape=1.0, com=0.02, smooth_s=0.1, force=3e-3)
MOST_REFINEMENTS = 3
MOST_RESETTLINGS = 4
THIRD_DERIVATIVE_WEIGHT = (
    1e-9  # weight against third derivatives when the recording is made a spline
)


# The fit is made finer than an adaptation needs, so that most adaptations need no more knots.
FIT_PROMISE = DenseTolerance(flight=4e-4, ground=1.5e-3, drift=1e-4)
ADAPT_PROMISE = DenseTolerance(flight=1e-3, ground=4e-3, drift=4e-4)


@dataclass(frozen=True)
class Solved:
    """A motion that was solved for: how each stage ended, and each contact's place."""

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
class Fit(Solved):
    """A fitted performance."""

    performance: Performance
    schedule: ContactSchedule

    @cached_property
    def metric(self) -> BlockBanded:
        """The norm in which adaptations of this fit are small."""
        return motion_metric(self.motion, ADAPT_PRICES)

    @cached_property
    def other_bodies(self) -> dict[BodyChange, Motion]:
        """The fit with other bodies, for arrange.py to keep: their functions take long to build."""
        return {}

    @cached_property
    def torques(self) -> TorqueFunction:
        """The torques of every joint."""
        return every_torque(self.motion.transcription)

    @cached_property
    def torque_metric(self) -> BlockBanded:
        """What changes of the fit's torques cost; see objectives.torque_metric."""
        return torque_metric(self.motion, self.torques)


def fit(
    performance: Performance,
    schedule: ContactSchedule,
    *,
    progress: Progress | None = None,
) -> Fit:
    """Finds the valid motion nearest to the recording, with its contacts."""
    transcription = transcribe(performance, schedule)
    x = first_guess(transcription, performance)
    places = np.array([c.contact.place for c in transcription.contacts]).reshape(-1, 3)
    closeness = TrackingCost(
        transcription, recorded_target(transcription, performance, x), FIT_PRICES
    )
    near = project(
        transcription, closeness, x, places, stage="fit", most_steps=8, progress=progress
    )
    metric = closeness.expand(near.x)[1]
    outcomes, last = [near], near
    for _ in range(1 + MOST_RESETTLINGS):
        last = restore(transcription, metric, last.x, places, stage="fit", progress=progress)
        outcomes.append(last)
        if last.status is Status.SOLVED:
            outcomes += refine(last, places, fitting_metric, FIT_PROMISE, progress=progress)
            break
        places = reached_places(Motion(last.transcription, last.x, places))
    settled = tuple(
        replace(contact, place=place)
        for contact, place in zip(schedule.contacts, places, strict=True)
    )
    return Fit(tuple(outcomes), places, performance, replace(schedule, contacts=settled))


def reached_places(motion: Motion) -> FloatArray:
    """(n_contacts, 3) m: where each pinned point is on average.

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
    places: FloatArray,
    metric_of: Callable[[Motion], BlockBanded],
    promise: DenseTolerance,
    *,
    basis: FloatArray | None = None,
    progress: Progress | None = None,
) -> list[Outcome]:
    """Splits spans until physics and pins hold between the nodes as promised (thesis 6.4)."""
    outcomes: list[Outcome] = []
    for _ in range(MOST_REFINEMENTS):
        motion = Motion(outcome.transcription, outcome.x, places)
        weak = weak_spans(motion, promise)
        if not len(weak):
            break
        finer = on_finer_basis(motion, weak)
        metric = metric_of(finer)
        finer_outcome = restore(
            finer.transcription,
            metric,
            finer.x,
            places,
            stage="refine",
            basis=basis,
            progress=progress,
        )
        if finer_outcome.status is not Status.SOLVED:
            break  # what was solved for stands; its residual between the nodes is reported
        outcome = finer_outcome
        outcomes.append(outcome)
    return outcomes


def on_finer_basis(motion: Motion, spans: IntArray) -> Motion:
    """The same motion with some spans split in two."""
    old = motion.transcription
    breaks = split(old.basis.breaks, spans)
    double = np.isin(breaks, old.basis.breaks[old.basis.double])
    basis = SplineBasis(breaks, double)
    new = replace(old, basis=basis)
    x = np.zeros((basis.n_coefficients, old.layout.n_block))
    x[:, old.layout.motion] = old.basis.insert_knots(basis, motion.x[:, old.layout.motion])
    inner = np.arange(basis.n_spans)
    nodes = basis.force_nodes(inner)
    middles = 0.5 * (breaks[:-1] + breaks[1:])
    was = old.basis.spans(middles)
    values = motion.x[old.basis.force_nodes(was) + 1][:, :, old.layout.forces]
    for side in range(2):
        weights = old.basis.force_weights(breaks[inner + side], was)
        x[nodes[:, side] + 1, old.layout.forces] = np.einsum("tk,tkn->tn", weights, values)
    x[~new.active] = 0.0
    return Motion(new, x, motion.places)


def fitting_metric(motion: Motion) -> BlockBanded:
    """The norm in which steps of a fit are small."""
    return motion_metric(motion, FIT_PRICES)


def motion_metric(motion: Motion, prices: CostWeights) -> BlockBanded:
    """The metric W at a motion."""
    return TrackingCost(motion.transcription, motion_target(motion), prices).expand(motion.x)[1]


def motion_target(motion: Motion) -> Target:
    """A solved motion as a target."""
    t = motion.transcription
    com = t.basis.combine(motion.x[:, t.layout.com], t.node_times)
    q, a = (t.angles_at_nodes(motion.x, k) for k in (0, 2))
    markers = forward_kinematics(t.character, q).points(marker_points(t.character)) + com[:, None]
    return Target(markers, com, a, motion.x[:, t.layout.forces])


def transcribe(performance: Performance, schedule: ContactSchedule) -> Transcription:
    """The equations of a performance with its contacts."""
    character = performance.character
    points, which = body_points(character, performance.recording, schedule)
    contacts, extra = point_contacts(schedule, which)
    return Transcription(
        character,
        _coarsest_faithful(performance, schedule.boundaries, extra),
        points,
        contacts,
        MomentFunction(character),
    )


def point_contacts(
    schedule: ContactSchedule, which: Sequence[int]
) -> tuple[tuple[PointContact, ...], list[float]]:
    """The contacts with the instants between which their points (which) are held still, and those
    of the instants that are no boundaries."""
    contacts: list[PointContact] = []
    extra: list[float] = []
    for contact, point in zip(schedule.contacts, which, strict=True):
        start, end = (
            _shared_instant(t, schedule.boundaries, extra)
            for t in _pinned(contact, schedule.duration)
        )
        contacts.append(PointContact(contact, point, start, end))
    return tuple(contacts), extra


def _coarsest_faithful(
    performance: Performance, boundaries: Sequence[float], extra: Sequence[float]
) -> SplineBasis:
    """The basis with the fewest knots that follows the recording; physics adds more (`refine`)."""
    for longest in SPANS:
        basis = SplineBasis(*phase_breaks(boundaries, extra, longest))
        angles = recorded_spline(basis, performance, performance.angles)
        posed = forward_kinematics(performance.character, basis.combine(angles, performance.times))
        off = posed.centres - forward_kinematics(performance.character, performance.angles).centres
        if np.sqrt((off**2).sum(axis=2).mean(axis=0)).max() < SPLINE_FIT_TOLERANCE:
            break
    return basis


def _pinned(contact: Contact, duration: float) -> tuple[float, float]:
    """When a contact's point is held still: all of it but a short while at either end."""
    settle = min(SETTLE, 0.25 * (contact.end - contact.start))
    start = contact.start if contact.start <= 0.0 else contact.start + settle
    end = contact.end if contact.end >= duration else contact.end - settle
    return start, end


def _shared_instant(t: float, boundaries: Sequence[float], extra: list[float]) -> float:
    """A break near t: one that is there already if it is close enough, else t itself, added."""
    near = min((*boundaries, *extra), key=lambda b: abs(b - t))
    if abs(near - t) < SHORTEST_SPAN:
        return near
    extra.append(t)
    return t


def body_points(
    character: Character, recording: Recording, schedule: ContactSchedule
) -> tuple[tuple[BodyPoint, ...], list[int]]:
    """The distinct points that touch, in their bodies' frames, and each contact's index of one."""
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


def first_guess(transcription: Transcription, performance: Performance) -> FloatArray:
    """The recording's own spline, and forces that share its centre of mass's acceleration."""
    basis, layout = transcription.basis, transcription.layout
    x = np.zeros((basis.n_coefficients, layout.n_block))
    x[:, layout.com] = recorded_spline(basis, performance, performance.com)
    x[:, layout.angles] = recorded_spline(basis, performance, performance.angles)
    spans = np.arange(basis.n_spans)
    middles = 0.5 * (basis.breaks[:-1] + basis.breaks[1:])
    load = basis.combine(x[:, layout.com], middles, 2)[:, 2] / STANDARD_GRAVITY + 1.0
    nodes = basis.force_nodes(spans) + 1
    for contact in transcription.contacts:
        inside = touching_spans(basis, contact.contact)
        for side in range(2):
            at = nodes[inside, side]
            x[at, layout.force(contact.point).start + 2] = np.clip(load[inside], 0.0, 4.0)
    vertical = range(layout.forces.start + 2, layout.n_block, 3)
    together = np.maximum((x[:, vertical] > 0).sum(axis=1, keepdims=True), 1)
    x[:, vertical] /= together
    x[~transcription.active] = 0.0
    return x


def recorded_spline(
    basis: SplineBasis, performance: Performance, samples: FloatArray
) -> FloatArray:
    """(n_coefficients, n) the spline nearest to samples (T, n) at the recording's frames.

    Fitted between the frames too: a short span may hold no frame, and a spline that nothing holds
    there would swing.
    """
    times = np.union1d(dense_instants(basis), performance.times)
    return basis.project(
        times, interpolate(performance.times, samples, times), THIRD_DERIVATIVE_WEIGHT
    )


def recorded_target(
    transcription: Transcription, performance: Performance, x: FloatArray
) -> Target:
    """The recording at the dynamics nodes; accelerations and forces as in the first guess x."""
    times = transcription.node_times
    return Target(
        markers=performance.points(marker_points(performance.character), times),
        com=interpolate(performance.times, performance.com, times),
        accelerations=transcription.angles_at_nodes(x, 2),
        forces=x[:, transcription.layout.forces],
    )


def greville(basis: SplineBasis) -> FloatArray:
    """(n_coefficients,) the instant that each coefficient stands for."""
    k = basis.knots
    return np.asarray((k[1:-3] + k[2:-2] + k[3:-1]) / 3.0)


def dense_instants(basis: SplineBasis, per_span: int = 4) -> FloatArray:
    """Instants that determine a spline on this basis."""
    return gauss_instants(basis.breaks, per_span)[0]
