"""Initial guess: the fit on the problem's own contacts, timeline and knots (thesis 6.2 to 6.4)."""

from collections.abc import Callable, Container, Sequence
from dataclasses import replace

import numpy as np

from ..analysis.pins.landing import Footing
from ..arrays import FloatArray
from ..constraints.contact_setup import detailed_contact
from ..constraints.evaluation_context import EvaluationContext
from ..data.constants import STANDARD_GRAVITY
from ..data.problem import MotionProblem
from ..data.requests import PointRequest
from ..data.solver_options import MIN_SPAN
from ..fitting.fit import Fit
from ..fitting.transcribe import body_points, point_contacts
from ..numerics.rotations import cross_matrix
from ..numerics.splines import THIRD_DERIVATIVE_WEIGHT, SplineBasis, dense_instants, phase_breaks
from ..transcription.contact_pins import PointContact
from ..transcription.motion import Motion
from ..transcription.transcription import Transcription
from ..unseen.support_force import harness, support_force
from .footing import on_faces

MAX_SPAN = 0.08  # s, between knots that are not the fit's
MAX_HELD_SPAN = 0.04  # s; a held frame tells nothing of the swing that physics makes of it


def resampled_fit(
    fit: Fit,
    problem: MotionProblem,
    context: EvaluationContext,
    added: dict[str, PointRequest],
    footing: Footing,
) -> Motion:
    """The reference on the problem's own contacts, timeline and knots, without constraints. Added
    contacts take over what they can of unseen support. footing: where contacts shall be.

    Raises UnknownPhaseIn, BadTiming, TooSteep."""
    reference, schedule = context.reference, context.schedule
    t = reference.transcription
    coarse = problem.requests.solution.longest_span
    same = context.timeline.unchanged and coarse is None and not added
    if same and len(schedule.contacts) == len(t.contacts):
        contacts = tuple(detailed_contact(c, problem, context, None) for c in t.contacts)
        contacts = on_faces(contacts, footing)
        if all(new is old for new, old in zip(contacts, t.contacts, strict=True)):
            return reference
        return replace(reference, transcription=replace(t, contacts=contacts))
    points, which = body_points(t.character, context.recording, schedule)
    plain, extra = point_contacts(schedule, which)
    support = support_force(schedule, [*schedule.boundaries, *extra], MIN_SPAN)
    if support is not None:
        points += harness(t.character)
        extra += [t for each in support.intervals for t in (each.start, each.end)]
    contacts = on_faces(
        [detailed_contact(c, problem, context, added.get(c.contact.name)) for c in plain], footing
    )
    if coarse is None:
        basis = _mapped_basis(t.basis, context, extra)
    else:
        basis = SplineBasis(*phase_breaks(schedule.jumps, [*schedule.boundaries, *extra], coarse))
    new = Transcription(
        t.character, basis, points, contacts, t.moment, periodic=t.periodic, support=support
    )
    x = _resampled(reference, new, context.timeline.eased)
    x = _taken_over(x, new, added)
    motion = Motion(new, x, np.zeros((len(contacts), 3)))
    return replace(motion, places=_current_places(motion, fit))


def _mapped_basis(
    old: SplineBasis, context: EvaluationContext, extra: Sequence[float]
) -> SplineBasis:
    """The old knots at their new instants, and those that new boundaries and holds need."""
    retiming, schedule = context.timeline, context.schedule
    fixed = sorted({*schedule.boundaries, *extra})
    kept: list[float] = []
    held = [
        np.linspace(hold.start, hold.end, 1 + int(np.ceil((hold.end - hold.start) / MAX_HELD_SPAN)))
        for hold in retiming.holds
    ]
    for t in np.unique(np.concatenate([retiming.to_new(old.breaks), *held])).tolist():
        near = min(abs(t - other) for other in (*fixed, *kept))
        if 0.0 < t < retiming.duration and near > MIN_SPAN:
            kept.append(t)
    return SplineBasis(*phase_breaks(schedule.jumps, [*fixed, *kept], MAX_SPAN))


def _resampled(
    motion: Motion, new: Transcription, to_old: Callable[[FloatArray], FloatArray]
) -> FloatArray:
    """Unknowns of a motion on another transcription: splines by least squares, forces at the nodes.

    to_old: instants (T,) s of the motion from those of the new one.
    """
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
                x[layout.force_block(nodes[:, side]), layout.force(contact.point)] = forces[
                    :, point
                ]
        if new.support is not None and old.support is not None:
            held = forces[:, -new.n_support :].reshape(len(forces), -1)
            x[layout.force_block(nodes[:, side]), new.support_columns] = held
    x[~new.active] = 0.0
    return x


def _taken_over(x: FloatArray, t: Transcription, added: Container[str]) -> FloatArray:
    """The unknowns with added contacts that can carry a weight carrying of what was unseen, while
    they hold, what they can from where they are: what is nearest to the fit, which does not know
    them, would leave them next to nothing."""
    able = [c for c in t.contacts if c.contact.name in added and c.bears_weight]
    if t.support is None or not able:
        return x
    x, motion = x.copy(), Motion(t, x, np.zeros((len(t.contacts), 3)))
    nodes, breaks = t.basis.force_nodes(np.arange(t.basis.n_spans)), t.basis.breaks
    once, first = np.unique(nodes, return_index=True)
    instants = np.stack([breaks[:-1], breaks[1:]], axis=1).ravel()[first]
    places = motion.contact_points(instants)
    for block, points in zip(t.layout.force_block(once).tolist(), places, strict=True):
        mine = [c for c in able if t.active[block, t.layout.force(c.point)].any()]
        if mine:
            unseen, at = x[block, t.support_columns].reshape(-1, 3), points[-t.n_support :]
            forces, rest = _shared(unseen, at, mine, points[[c.point for c in mine]])
            x[block, t.support_columns] = rest.ravel()
            for contact, force in zip(mine, forces, strict=True):
                x[block, t.layout.force(contact.point)] += force
    return x


def _shared(
    unseen: FloatArray, at: FloatArray, contacts: Sequence[PointContact], places: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Forces of contacts at places (n, 3), and what is left of the unseen ones (m, 3) at points
    (m, 3): as little as can be, with the same sum and moment. Who leans on a table beside a chair
    still sits on the chair. No contact pulls but a grip."""
    middle = at.mean(axis=0)
    held, pushed = (_wrenches(points - middle) for points in (at, places))
    left = np.linalg.pinv(held)  # (3 m, 6), the least forces there of a force and a moment
    wrench = held @ unseen.ravel()
    forces = np.linalg.lstsq(left @ pushed, left @ wrench, rcond=None)[0].reshape(-1, 3)
    normals = np.array([contact.normal for contact in contacts])
    grips = np.array([contact.friction is None for contact in contacts])
    forces[((forces * normals).sum(axis=1) < 0.0) & ~grips] = 0.0
    return forces, left @ (wrench - pushed @ forces.ravel())


def _wrenches(places: FloatArray) -> FloatArray:
    """(6, 3 n) sum and moment of forces at places (n, 3)."""
    return np.concatenate([np.vstack([np.eye(3), cross_matrix(p)]) for p in places], axis=1)


def _current_places(motion: Motion, fit: Fit) -> FloatArray:
    """(n_contacts, 3) m: the fit's place of each contact; where the point is, for a new one."""
    known = {c.name: place for c, place in zip(fit.schedule.contacts, fit.places, strict=True)}
    places = []
    for contact in motion.transcription.contacts:
        if contact.contact.name in known:
            places.append(known[contact.contact.name])
        else:
            times = np.linspace(contact.contact.start, contact.contact.end, 20)
            places.append(motion.contact_points(times)[:, contact.point].mean(axis=0))
    return np.array(places).reshape(-1, 3)
