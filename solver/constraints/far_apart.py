"""Places that nobody can hold at once, or one after the other: found before anything is solved."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from ..arrays import FloatArray
from ..body.character import Character
from ..body.kinematics import BodyPoint
from ..data.faults import ContradictoryPins, OutOfReach
from ..data.requests import Requests
from ..transcription.motion import Motion
from .evaluation_context import EvaluationContext
from .point_constraints import point_place

SLACK = 0.02  # m: soles give, and toes bend
INSTANTS = 9  # at which places are compared while both are held
FASTEST = 12.5  # m/s; nobody has run faster (Bolt 2009: 12.3)
LONGER = 2.0  # times the recording's, that a flight may last in the end


@dataclass(frozen=True)
class HeldPoint:
    """A point of the body that is held from start to end, s.

    place: m, world, (U, 3) at instants (U,) s. asked: whether the artist put it there. was: (3,) m,
    where a contact was recorded; None of what was never there.
    """

    name: str
    point: BodyPoint
    start: float
    end: float
    place: Callable[[FloatArray], FloatArray]
    asked: bool
    was: FloatArray | None = None


def check_apart(
    requests: Requests,
    context: EvaluationContext,
    motion: Motion,
    recorded: FloatArray,
    pinned: Mapping[str, str],
) -> None:
    """Refuses places that are further apart than the body is long, or than it can go in time.

    motion: with the contacts at their places. recorded: (n_contacts, 3) m, where they were; what
    was as far apart there is the fit's affair. pinned: the pin that moves a contact, by names.
    Raises ContradictoryPins, OutOfReach.
    """
    held = [*_contacts(motion, recorded, pinned), *_points(requests, context)]
    for one, other in combinations(held, 2):
        if not (one.asked or other.asked):
            continue  # what was recorded is the fit's affair
        least, most = reach(context.character, one.point, other.point)
        was = _recorded_apart(one, other)
        first, second = (one, other) if one.asked else (other, one)
        if _together(one, other):
            times = np.linspace(max(one.start, other.start), min(one.end, other.end), INSTANTS)
            apart = np.linalg.norm(one.place(times) - other.place(times), axis=1)
            if was is not None:
                least, most = min(least, was), max(most, was)
            wrong = float(max(apart.max() - most, least - apart.min()))
            if wrong > SLACK:
                raise ContradictoryPins(first.name, second.name, wrong)
        elif requests.solution.human:
            _check_speed(first, second, most, 0.0 if was is None else was)


def _recorded_apart(one: HeldPoint, other: HeldPoint) -> float | None:
    """Distance of two recorded contacts, m; None where one of the two was not recorded."""
    if one.was is None or other.was is None:
        return None
    return float(np.linalg.norm(one.was - other.was))


def _check_speed(one: HeldPoint, other: HeldPoint, most: float, was: float) -> None:
    """most: m, by which the two points of the body are apart at most. was: m, in the recording."""
    former, latter = (one, other) if one.end <= other.start else (other, one)
    seconds = latter.start - former.end
    ends = former.place(np.array([former.end])), latter.place(np.array([latter.start]))
    apart = float(np.linalg.norm(ends[0] - ends[1]))
    if apart > max(most + FASTEST * LONGER * seconds, was + SLACK):
        raise OutOfReach(one.name, other.name, apart, seconds)


def _together(one: HeldPoint, other: HeldPoint) -> bool:
    """Whether both are held at one time; those that only follow each other are not."""
    start, end = max(one.start, other.start), min(one.end, other.end)
    instant = one.start == one.end or other.start == other.end
    return end > start or (instant and end == start)


def _contacts(
    motion: Motion, recorded: FloatArray, pinned: Mapping[str, str]
) -> Iterator[HeldPoint]:
    """Those that stand on ground that is still."""
    t = motion.transcription
    for contact, place, was in zip(t.contacts, motion.places, recorded, strict=True):
        free = contact.held is not None or contact.track is not None or contact.ride is not None
        if not free:
            name, point = contact.contact.name, t.points[contact.point]
            yield HeldPoint(
                pinned.get(name, name),
                point,
                contact.contact.start,
                contact.contact.end,
                _still(place),
                name in pinned or contact.contact.asked_for,
                None if contact.contact.asked_for else was,
            )


def _points(requests: Requests, context: EvaluationContext) -> Iterator[HeldPoint]:
    """Those that are held exactly, and not as contacts."""
    for request in requests.points:
        if request.bounds is not None or request.environment:
            continue
        span = context.interval(request.name, request.when)
        point = context.point(context.body(request.name, request.bone), request.offset)
        yield HeldPoint(
            request.name, point, *span, point_place(request, context, point, span), asked=True
        )


def _still(place: FloatArray) -> Callable[[FloatArray], FloatArray]:
    return lambda times: np.tile(place, (len(times), 1))


def reach(character: Character, one: BodyPoint, other: BodyPoint) -> tuple[float, float]:
    """Bounds (m) of the distance of two points: from joint to joint along the body at most."""
    lines = character.ancestors(one.body), character.ancestors(other.body)
    common = next(body for body in lines[0] if body in lines[1])
    (first, at), (second, there) = (
        _climbed(character, point.place, line[: line.index(common)])
        for point, line in zip((one, other), lines, strict=True)
    )
    between = float(np.linalg.norm(at - there))
    longest = first + between + second
    return (between if one.body == other.body else 0.0), longest


def _climbed(
    character: Character, place: FloatArray, bodies: Sequence[int]
) -> tuple[float, FloatArray]:
    """The way (m) from a place in the first of bodies up to the last one's parent, and the joint
    at its end, in that parent's frame."""
    way = 0.0
    for body in bodies:
        way += float(np.linalg.norm(place))
        place = character.joints[body].offset
    return way, place
