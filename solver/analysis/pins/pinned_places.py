"""Target positions of contacts: the recorded places, moved by the artist's pins (thesis 6.2)."""

from collections.abc import Mapping, Sequence

import numpy as np

from ...arrays import FloatArray
from ...contacts.footfalls import footfalls
from ...data.constants import UP
from ...data.contacts import ContactSchedule, Phase, PhaseKind
from ...data.faults import BeyondPrecision, ContradictoryPins, UnknownContact, UnknownPhase
from ...data.problem import MotionProblem, OffsetAxes, Pin
from ...data.scene import SceneObject
from ...scene.checks import named
from ...scene.triangle_mesh import placed_mesh
from ..performance import Performance
from .landing import Footing, Ground, land

SAME_BODY_TOLERANCE = 0.003  # m
SAME_FOOT_TOLERANCE = 0.02  # m; toes bend
# m; Blender's places are in single precision, which tells 0.06 mm there: contacts are held to that
FURTHEST = 1000.0
FOOT_LENGTH = 0.152  # of the stature (Drillis & Contini 1966)
BACKWARDS = float(np.cos(np.radians(120.0)))  # of travel to facing; sideways jumps go by 90°
SLOW_WALK = 1.0  # m/s; a runner's flights are short, but he goes somewhere


def pinned_places(
    problem: MotionProblem, performance: Performance, schedule: ContactSchedule
) -> FloatArray:
    """(n_contacts, 3) m: target position of every contact, world. Raises as `pinned_footing`."""
    return pinned_footing(problem, performance, schedule).places


def pinned_footing(
    problem: MotionProblem,
    performance: Performance,
    schedule: ContactSchedule,
    standing: Mapping[Pin, SceneObject] | None = None,
) -> Footing:
    """Target position of every contact, and the normal of what it stands on.

    standing: of pins on objects that move, the object as it is when they land.

    Raises UnknownPhase, UnknownContact, BeyondPrecision, ContradictoryPins, UnknownObject, and as
    `land` does.
    """
    places = np.array([c.place for c in schedule.contacts]).reshape(-1, 3)
    normals = np.tile(UP, (len(places), 1))
    moved_by: dict[int, Pin] = {}
    landed: dict[str, Pin] = {}
    for pin in problem.pins:
        phase = phase_of(pin, schedule)
        chosen = chosen_contacts(pin, phase, schedule)
        target = _moved(pin, phase, chosen, performance, schedule)
        _check_near(pin, places[chosen], target)
        if pin.on is not None:
            thing = (standing or {}).get(pin) or named(pin.name, pin.on, problem.scene)
            footing = _landed(pin, thing, chosen, target, performance, schedule)
            target, normals[chosen] = footing.places, footing.normals
            landed |= {schedule.contacts[i].name: pin for i in chosen}
        for i, place in zip(chosen, target, strict=True):
            if i in moved_by:
                apart = float(np.linalg.norm(places[i] - place))
                if apart > SAME_BODY_TOLERANCE:
                    raise ContradictoryPins(moved_by[i].name, pin.name, apart)
            places[i] = place
            moved_by[i] = pin
    _check_rigid(schedule, performance, places, moved_by)
    return Footing(places, normals, landed)


def _check_near(pin: Pin, places: FloatArray, target: FloatArray) -> None:
    """places, target: (k, 3) m. Raises BeyondPrecision."""
    moved = float(np.linalg.norm(target - places, axis=1).max(initial=0.0))
    if moved > FURTHEST:
        raise BeyondPrecision(pin.name, moved, FURTHEST)


def _landed(
    pin: Pin,
    thing: SceneObject,
    chosen: list[int],
    places: FloatArray,
    performance: Performance,
    schedule: ContactSchedule,
) -> Footing:
    """The chosen contacts, at places (k, 3) m, on the object that their pin names."""
    contacts = [schedule.contacts[i] for i in chosen]
    ground = Ground(pin.name, thing, placed_mesh(thing))
    return land(ground, contacts, places, performance.character, schedule.floor_m)


def phase_of(pin: Pin, schedule: ContactSchedule) -> Phase:
    """The ground phase that a pin names, in which something touches. Raises UnknownPhase."""
    for phase in schedule.stances:
        if phase.name == pin.phase:
            return phase
    raise UnknownPhase(pin.name, pin.phase, tuple(p.name for p in schedule.stances))


def chosen_contacts(pin: Pin, phase: Phase, schedule: ContactSchedule) -> list[int]:
    """Indices of the contacts that a pin moves. Raises UnknownContact."""
    there = [
        i for i, c in enumerate(schedule.contacts) if c.start < phase.end and c.end > phase.start
    ]
    if pin.step is not None:
        return _step(pin, pin.step, there, schedule)
    if not pin.touching:
        return there
    chosen = []
    for what in pin.touching:
        hits = [
            i
            for i in there
            if what in (schedule.contacts[i].bone, schedule.contacts[i].point)
            or what == schedule.contacts[i].name
        ]
        if not hits:
            known = sorted({c.point for c in schedule.of_phase(phase)})
            known += sorted({c.bone for c in schedule.of_phase(phase)})
            raise UnknownContact(pin.name, what, tuple(known))
        chosen += [i for i in hits if i not in chosen]
    return chosen


def _step(pin: Pin, step: str, there: list[int], schedule: ContactSchedule) -> list[int]:
    """Those of the contacts that are there which are of one footfall with one of them, by its name.
    Raises UnknownContact."""
    names = [schedule.contacts[i].name for i in there]
    if step not in names:
        raise UnknownContact(pin.name, step, tuple(names))
    steps = footfalls([schedule.contacts[i].touch for i in there])
    mine = next(each for each in steps if names.index(step) in each)
    return sorted(there[k] for k in mine)


def pinned_by(pins: Sequence[Pin], schedule: ContactSchedule) -> dict[str, str]:
    """The pin that moves each contact that one moves, by names. Raises UnknownPhase,
    UnknownContact."""
    found: dict[str, str] = {}
    for pin in pins:
        chosen = chosen_contacts(pin, phase_of(pin, schedule), schedule)
        found |= {schedule.contacts[i].name: pin.name for i in chosen}
    return found


def _moved(
    pin: Pin,
    phase: Phase,
    chosen: list[int],
    performance: Performance,
    schedule: ContactSchedule,
) -> FloatArray:
    """(len(chosen), 3) m: the chosen contacts' places turned and moved by a pin."""
    places = np.array([schedule.contacts[i].place for i in chosen])
    centre = places.mean(axis=0)
    c, s = np.cos(pin.turn), np.sin(pin.turn)
    turned = centre + (places - centre) @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    offset = np.array(pin.offset, dtype=float)
    if pin.axes is OffsetAxes.TRAVEL:
        offset = travel_axes(performance, schedule, phase) @ offset
    goal = centre if pin.place is None else np.array(pin.place, dtype=float)
    return np.asarray(turned - centre + goal + offset)


def travel_axes(performance: Performance, schedule: ContactSchedule, phase: Phase) -> FloatArray:
    """(3, 3) travel frame, columns forward, left and up in world axes, of a ground phase.

    Forward: level, along the flight that ends in the phase, or else the first one. Who lands
    on his own footprints goes nowhere: then it is where the pelvis faces at the take-off.
    """
    flight = _flight_of(schedule, phase)
    com = performance.com
    start, end = (
        np.array([np.interp(t, performance.times, com[:, k]) for k in range(3)])
        for t in (flight.start, flight.end)
    )
    ahead = (end - start) * np.array([1.0, 1.0, 0.0])
    gone, seconds = float(np.linalg.norm(ahead)), flight.end - flight.start
    if gone < FOOT_LENGTH * performance.character.height and gone < SLOW_WALK * seconds:
        ahead = facing(performance, flight.start)
    ahead /= np.linalg.norm(ahead)
    return np.stack([ahead, np.cross(UP, ahead), UP], axis=1)


def backward_stances(performance: Performance, schedule: ContactSchedule) -> tuple[str, ...]:
    """Names of the ground phases whose forward is at the body's back."""
    return tuple(p.name for p in schedule.stances if _goes_backwards(performance, schedule, p))


def _goes_backwards(performance: Performance, schedule: ContactSchedule, phase: Phase) -> bool:
    """As the body faces at the take-off."""
    faces = facing(performance, _flight_of(schedule, phase).start)
    ahead = travel_axes(performance, schedule, phase)[:, 0]
    return float(faces @ ahead) < BACKWARDS * float(np.linalg.norm(faces))


def _flight_of(schedule: ContactSchedule, phase: Phase) -> Phase:
    """The flight that ends in a ground phase, else the first one, else the phase."""
    flights = [p for p in schedule.phases if p.kind is PhaseKind.FLIGHT]
    before = [f for f in flights if f.end <= phase.start + 1e-9]
    return before[-1] if before else (flights[0] if flights else phase)


def facing(performance: Performance, time: float) -> FloatArray:
    """(3,) level direction in which the pelvis faces, not normalised."""
    frame = int(np.argmin(np.abs(performance.times - time)))
    width = performance.rotations[frame, 0] @ performance.character.bodies[0].box_rotation[:, 0]
    return np.asarray(np.cross(width, UP) * np.array([1.0, 1.0, 0.0]))


def _check_rigid(
    schedule: ContactSchedule,
    performance: Performance,
    places: FloatArray,
    moved_by: dict[int, Pin],
) -> None:
    """Rigidity check: heel and toe of one foot keep their distance. Raises ContradictoryPins."""
    contacts = schedule.contacts
    bodies = {body.bone: body for body in performance.character.bodies}
    for i, first in enumerate(contacts):
        for j in range(i + 1, len(contacts)):
            second = contacts[j]
            one, two = bodies[first.bone], bodies[second.bone]
            together = first.start < second.end and second.start < first.end
            feet = {one.part.value, two.part.value} <= {"foot", "toe"}
            if not together or one.side is not two.side or not feet:
                continue
            slack = SAME_BODY_TOLERANCE if first.bone == second.bone else SAME_FOOT_TOLERANCE
            was = np.linalg.norm(first.place - second.place)
            now = np.linalg.norm(places[i] - places[j])
            if abs(now - was) > slack:
                names = [moved_by[k].name if k in moved_by else contacts[k].name for k in (i, j)]
                if names[0] == names[1]:
                    names = [contacts[i].name, contacts[j].name]
                raise ContradictoryPins(names[0], names[1], float(abs(now - was)))
