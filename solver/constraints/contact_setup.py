"""Contact set-up: contacts lifted, added, or given friction and a path (thesis 3.3, 6.2)."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..analysis.timeline import MIN_PHASE_DURATION
from ..data.contacts import Contact, ContactSchedule
from ..data.faults import BadTiming, FreePoint, NothingTouches, TakenName, UnknownPhaseIn
from ..data.problem import MotionProblem
from ..data.requests import ConeShape, PointRequest
from ..transcription.contact_pins import PlaceTrajectory, PointContact
from .evaluation_context import EvaluationContext, touches
from .point_constraints import path_instants, path_places, point_axes, point_place


def without_lifted(schedule: ContactSchedule, problem: MotionProblem) -> ContactSchedule:
    """The schedule without lifted contacts; phases keep their names. Raises UnknownPhaseIn,
    NothingTouches."""
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
    return replace(schedule, contacts=kept).named_as(schedule)


def added_contact(request: PointRequest, context: EvaluationContext) -> Contact:
    """Contact of an environment point while it holds.

    Raises StillBone, UnknownPhaseIn, BadTiming, TakenName, FreePoint.
    """
    body = context.body(request.name, request.bone)
    span = context.interval(request.name, request.when)
    if span[1] - span[0] < MIN_PHASE_DURATION:
        raise BadTiming(request.name, span[1] - span[0])
    if any(request.name in (c.name, c.point) for c in context.schedule.contacts):
        raise TakenName(request.name)
    if request.bounds is not None and (0.0, 0.0) not in request.bounds:
        raise FreePoint(request.name)
    point = context.point(body, request.offset)
    place = point_place(request, context, point, span)(np.array([span[0]]))[0]
    bone = context.recording.bones[context.recording.index(request.bone)]
    offset = bone.rotation.T @ point.place
    return Contact(request.name, request.name, request.bone, offset, *span, place)


def with_added(schedule: ContactSchedule, added: Sequence[Contact]) -> ContactSchedule:
    """The schedule with contacts added, in order of start; phases keep their names."""
    contacts = sorted([*schedule.contacts, *added], key=lambda c: (c.start, c.point))
    return replace(schedule, contacts=tuple(contacts)).named_as(schedule)


def detailed_contact(
    contact: PointContact,
    problem: MotionProblem,
    context: EvaluationContext,
    request: PointRequest | None,
) -> PointContact:
    """A contact with its friction; with held directions, path and grip of an environment point.

    The very same where nothing of it is asked for.
    Raises UnknownPhaseIn, BadTiming.
    """
    friction, pyramid = contact.friction, False
    for force in problem.requests.forces:
        shaped = force.friction is not None or force.shape is ConeShape.PYRAMID
        if shaped and touches(force.touching, contact.contact):
            start, end = context.interval(force.name, force.when)
            if contact.contact.start < end and contact.contact.end > start:
                friction = friction if force.friction is None else force.friction
                pyramid = force.shape is ConeShape.PYRAMID
    if (friction, pyramid) != (contact.friction, contact.pyramid):
        contact = replace(contact, friction=friction, pyramid=pyramid)
    if request is None:
        return contact
    span = (contact.contact.start, contact.contact.end)
    held, track = None, None
    if request.bounds is not None:
        axes = point_axes(request, context, span)
        held = axes.T[[bound == (0.0, 0.0) for bound in request.bounds]]
    if request.path is not None:
        times, places = path_instants(request.path, context.timeline), np.array(request.path.places)
        begin = path_places(request.path, context.timeline)(np.array(span[:1]))
        track = PlaceTrajectory(times, places - begin)
    return replace(contact, held=held, track=track, friction=None if request.grip else friction)
