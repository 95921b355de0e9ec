"""Transcription of a recording: knots, contacts, initial guess and target (thesis 4.2, 6.4)."""

from collections.abc import Sequence

import numpy as np

from ..analysis.accelerations import angle_accelerations, com_acceleration, velocities
from ..analysis.performance import Performance
from ..arrays import FloatArray
from ..body.character import Character
from ..body.dynamics import MomentFunction
from ..body.kinematics import BodyPoint, forward_kinematics
from ..data.constants import STANDARD_GRAVITY
from ..data.contacts import ContactSchedule
from ..data.recording import Recording
from ..data.solver_options import MIN_SPAN
from ..numerics.interpolation import interpolate
from ..numerics.splines import THIRD_DERIVATIVE_WEIGHT, SplineBasis, dense_instants, phase_breaks
from ..objectives.cost_to_go import EndTarget
from ..objectives.tracking_cost import TrackingTarget, marker_points
from ..transcription.compliant_sole import sole_trajectory
from ..transcription.contact_pins import PointContact, touching_spans
from ..transcription.transcription import Transcription
from ..unseen.support_force import harness, support_force

CANDIDATE_SPANS = (0.04, 0.03, 0.025)  # s, longest knot spans to choose from
SPLINE_FIT_TOLERANCE = 0.004  # m, rms spline-fit error of a joint centre
EDGE_SPAN = 0.02  # s; the span before a landing and after a lift-off, in which feet stop and start
MIN_LOAD = 0.25  # of the weight, with which the direction of the contact force is known
MAX_SLOPE = 0.5  # of that direction; runners and jumpers on force plates use 0.25 to 0.6


def transcribe(
    performance: Performance, schedule: ContactSchedule, *, periodic: bool = False
) -> Transcription:
    """Transcription of a performance with its contacts. periodic: whether it is one cycle."""
    character = performance.character
    points, which = body_points(character, performance.recording, schedule)
    contacts, extra = point_contacts(schedule, which)
    instants = [*schedule.boundaries, *extra]
    support = support_force(schedule, instants, MIN_SPAN)
    if support is not None:
        points += harness(character)
        instants += [t for each in support.intervals for t in (each.start, each.end)]
    return Transcription(
        character,
        _coarsest_basis(performance, schedule.jumps, instants),
        points,
        contacts,
        MomentFunction(character),
        periodic=periodic,
        support=support,
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
    if transcription.support is not None:
        columns = range(layout.n_block)[transcription.support_columns][2::3]
        for inside in transcription.support.spans(basis):
            alone = inside[~x[blocks[inside]][:, :, layout.vertical_forces].any(axis=(1, 2))]
            for side in range(2):
                x[np.ix_(blocks[alone, side], columns)] = load[alone, None]
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
        angles=interpolate(performance.times, performance.angles, times),
        accelerations=angle_accelerations(performance, times),
        com_acceleration=com_acceleration(performance, schedule, times),
        forces=np.zeros((basis.n_coefficients, 3 * transcription.layout.n_points)),
        slope=np.clip(load[:, :2] / np.maximum(load[:, 2:], MIN_LOAD), -MAX_SLOPE, MAX_SLOPE),
        ends=EndTarget(performance.points(markers, ends), *velocities(performance, ends)),
    )
