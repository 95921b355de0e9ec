"""Stances on moving ground: who rides on what, and who is carried on by a take-off from it.

A pin that names an object that moves holds its contacts to the points of the object over which they
stand at the stance's first instant. The next stance on the same object keeps to the same points: it
goes along while the body flies. Stances that no pin names go where the take-off's own speed takes
them: a jump from a train is the recorded jump, carried along.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..analysis.pins.landing import Footing
from ..analysis.pins.pinned_places import chosen_contacts, phase_of
from ..arrays import FloatArray
from ..constraints.evaluation_context import EvaluationContext
from ..data.contacts import ContactSchedule, Phase, PhaseKind
from ..data.faults import GroundNotThere, JerkyGround
from ..data.problem import MotionProblem, Pin
from ..data.recording import Recording
from ..data.scene import SceneObject
from ..fitting.fit import Fit
from ..numerics.rotations import axis_rotation
from ..scene.object_motion import ObjectMotion
from ..transcription.ride import Ride
from .footing import find_footing
from .warm_start import Standing

MAX_ACCELERATION = 100.0  # m/s², of a point of the ground; nobody stands on what jumps
CHECKING_RATE = 240.0  # Hz
FRAME_TOLERANCE = 0.01  # scene frames
RESTING_SPEED = 0.05  # m/s, and rad/s: ground slower than that stands still, as feet on it do
RESTING_SAMPLES = 50


@dataclass(frozen=True)
class TakeOff:
    """A take-off from moving ground, as a steady rigid motion from its instant on.

    time: s. recorded, placed: (3,) m, the centre of mass without and with the ground's motion.
    velocity: (3,) m/s of the ground below it. turn: rad, spin: rad/s about the vertical.
    """

    time: float
    recorded: FloatArray
    placed: FloatArray
    velocity: FloatArray
    turn: float
    spin: float

    def carried(self, places: FloatArray, time: float) -> FloatArray:
        """Places (n, 3) m of a stance that begins at `time`, s, carried on level."""
        flown = time - self.time
        centre = places.mean(axis=0)
        ahead = axis_rotation(2, self.turn) @ (centre - self.recorded)
        to = self.placed + flown * self.velocity + ahead
        to[2] = centre[2]
        turned = axis_rotation(2, self.turn + flown * self.spin)
        return np.asarray(to + (places - centre) @ turned.T)

    def landed(self, was: FloatArray, now: FloatArray, phase: Phase) -> "TakeOff":
        """The next take-off, after a stance on still ground that was carried from `was` (n, 3) m
        to `now`."""
        turn = self.turn + (phase.start - self.time) * self.spin
        return TakeOff(phase.end, was.mean(axis=0), now.mean(axis=0), np.zeros(3), turn, 0.0)


def find_standing(
    fit: Fit, problem: MotionProblem, context: EvaluationContext
) -> tuple[Standing, Footing]:
    """Where the problem's contacts stand and ride, and the faces that they stand on there.

    Raises as `find_footing` does, and GroundNotThere, JerkyGround.
    """
    footing = first_footing(fit, problem, context)
    moving = _moving(problem, context)
    if not any(pin.on in moving for pin in problem.pins):
        return Standing(footing.places, _kept_rides(fit, problem, context)), footing
    return _Walk(fit, problem, context, footing).through()


def first_footing(fit: Fit, problem: MotionProblem, context: EvaluationContext) -> Footing:
    """Where contacts would stand had the ground not moved since the first stance on it.

    Raises as `find_footing` does.
    """
    began, moving = _began(fit, problem, context), _moving(problem, context)
    standing = {pin: moving[pin.on or ""].still_at(time) for pin, time in began.items()}
    return find_footing(fit, problem, context.schedule, standing)


def recorded_rides(
    schedule: ContactSchedule, scene: Sequence[SceneObject], recording: Recording
) -> tuple[Ride | None, ...]:
    """Of the contacts (n_contacts,) of a recording: those on ground that moves meanwhile."""
    first, rate = float(recording.frames[0]), recording.rate
    moving = {each.name: ObjectMotion.of(each, first, rate) for each in scene if each.moves}
    return tuple(
        _recorded_ride(moving[contact.on], schedule.stance(contact))
        if contact.on in moving
        else None
        for contact in schedule.contacts
    )


def _recorded_ride(ground: ObjectMotion, phase: Phase) -> Ride | None:
    """None where the ground waits: then it is as still as any."""
    times = np.linspace(phase.start, phase.end, RESTING_SAMPLES)
    rates = ground.surface_rates(times)
    speed = max(float(np.abs(rates.shift).max()), float(np.abs(rates.turn).max()))
    return Ride(ground, phase.start) if speed > RESTING_SPEED else None


def recorded_in(fit: Fit, context: EvaluationContext) -> tuple[Ride | None, ...]:
    """Of the contacts of a context's schedule, the rides that they have in the fit."""
    known = {c.contact.name: c.ride for c in fit.motion.transcription.contacts}
    return tuple(known.get(contact.name) for contact in context.schedule.contacts)


def _kept_rides(
    fit: Fit, problem: MotionProblem, context: EvaluationContext
) -> tuple[Ride | None, ...]:
    """The rides that contacts have in the fit, but for those that a pin puts on something else."""
    rides = list(recorded_in(fit, context))
    for stance in _stances(fit, problem, context):
        for i, pin in stance.pins.items():
            ride = rides[i]
            if ride is not None and pin.on not in (None, ride.ground.thing.name):
                rides[i] = None
    return tuple(rides)


def _moving(problem: MotionProblem, context: EvaluationContext) -> dict[str, ObjectMotion]:
    """The objects that move, by name."""
    line = context.timeline
    return {
        each.name: ObjectMotion.of(each, line.first_frame, line.rate)
        for each in problem.scene
        if each.moves
    }


@dataclass(frozen=True)
class _Stance:
    """A ground phase, its contacts that were found, and the pins of some of them, by index.

    recorded_on: names of the moving objects on which the recording has it.
    """

    phase: Phase
    contacts: tuple[int, ...]
    pins: Mapping[int, Pin]
    recorded_on: frozenset[str]


def _stances(fit: Fit, problem: MotionProblem, context: EvaluationContext) -> Iterator[_Stance]:
    """In order."""
    pins = {
        fit.schedule.contacts[i].name: pin
        for pin in problem.pins
        for i in chosen_contacts(pin, phase_of(pin, fit.schedule), fit.schedule)
    }
    contacts, rides = context.schedule.contacts, recorded_in(fit, context)
    for phase in context.schedule.phases:
        mine = tuple(
            i
            for i, c in enumerate(contacts)
            if c.start < phase.end and c.end > phase.start and not c.asked_for
        )
        if phase.kind is PhaseKind.GROUND and mine:
            named = {i: pins[contacts[i].name] for i in mine if contacts[i].name in pins}
            on = frozenset(ride.ground.thing.name for ride in (rides[i] for i in mine) if ride)
            yield _Stance(phase, mine, named, on)


def _began(fit: Fit, problem: MotionProblem, context: EvaluationContext) -> dict[Pin, float]:
    """When each pin's contacts, s, came to stand on what moves: with the first of the stances in
    a row that stand on it."""
    moving, began = _moving(problem, context), dict[Pin, float]()
    last: dict[str, float] = {}
    for stance in _stances(fit, problem, context):
        now: dict[str, float] = {}
        for pin in stance.pins.values():
            if pin.on in moving:
                own = stance.phase.start
                anew = pin.place is not None or pin.on in stance.recorded_on
                began[pin] = own if anew else last.get(pin.on, own)
                now[pin.on] = began[pin]
        last = now
    return began


class _Walk:
    """Goes through the stances in time."""

    def __init__(
        self, fit: Fit, problem: MotionProblem, context: EvaluationContext, footing: Footing
    ) -> None:
        self._fit, self._context, self._first = fit, context, footing
        self._stances = tuple(_stances(fit, problem, context))
        self._moving = _moving(problem, context)
        self._began = _began(fit, problem, context)
        self._places, self._normals = footing.places.copy(), footing.normals.copy()
        self._recorded = _kept_rides(fit, problem, context)
        self._rides = list(self._recorded)
        self._take_off: TakeOff | None = None

    def through(self) -> tuple[Standing, Footing]:
        for stance in self._stances:
            self._stand(stance)
        standing = Standing(self._places, tuple(self._rides))
        return standing, Footing(self._places, self._normals, self._first.pins)

    def _stand(self, stance: _Stance) -> None:
        riding = [i for i, pin in stance.pins.items() if pin.on in self._moving]
        known = [ride for ride in (self._recorded[i] for i in riding) if ride is not None]
        for i in riding:
            self._ride(i, stance)
        if known:  # the recording has the ground's speed
            self._take_off = None
        elif riding:
            self._take_off = self._left(stance, riding)
        elif stance.pins:
            self._take_off = None
        elif self._take_off is not None:
            mine = list(stance.contacts)
            was = self._places[mine]
            self._places[mine] = self._take_off.carried(was, stance.phase.start)
            self._take_off = self._take_off.landed(was, self._places[mine], stance.phase)

    def _ride(self, contact: int, stance: _Stance) -> None:
        """Takes a contact along to its stance's first instant, and on from there."""
        pin, phase = stance.pins[contact], stance.phase
        ground = self._moving[pin.on or ""]
        _check_frames(pin, ground, phase)
        gone = Ride(ground, self._began[pin]).poses(np.array([phase.start]))
        self._places[contact] = gone.of(self._places[contact])[0]
        self._normals[contact] = gone.turn[0] @ self._normals[contact]
        ride = Ride(ground, phase.start)
        _check_smooth(pin, ride, self._places[contact], phase)
        self._rides[contact] = ride

    def _left(self, stance: _Stance, riding: Sequence[int]) -> TakeOff:
        """How the body leaves a stance that rides, by the contact that carries last."""
        contacts, end = self._context.schedule.contacts, stance.phase.end
        pin = stance.pins[max(riding, key=lambda i: contacts[i].end)]
        ride = Ride(self._moving[pin.on or ""], self._began[pin])
        known = {c.name: c.place for c in self._fit.schedule.contacts}
        offset = np.mean([self._first.places[i] - known[contacts[i].name] for i in riding], axis=0)
        at = np.array([end])
        com = self._fit.motion.com(self._context.reference_times(at))[0] + offset
        pose, rate = ride.poses(at), ride.rates(at)
        placed, turn = pose.of(com)[0], pose.turn[0]
        whirl = rate.turn[0] @ turn.T
        yaw = float(np.arctan2(turn[1, 0], turn[0, 0]))
        return TakeOff(end, com, placed, ride.velocity(placed, end), yaw, float(whirl[1, 0]))


# ---------------------------------------------------------------- faults


def _check_frames(pin: Pin, ground: ObjectMotion, phase: Phase) -> None:
    """Raises GroundNotThere where the object's poses do not cover the stance."""
    frames = ground.thing.frames
    if len(frames) < 2:
        return
    needed = ground.frame(phase.start), ground.frame(phase.end)
    known = float(frames[0]), float(frames[-1])
    if needed[0] < known[0] - FRAME_TOLERANCE or needed[1] > known[1] + FRAME_TOLERANCE:
        raise GroundNotThere(pin.name, ground.thing.name, phase.name, known, needed)


def _check_smooth(pin: Pin, ride: Ride, place: FloatArray, phase: Phase) -> None:
    """Raises JerkyGround where the ground jumps under a place (3,) m."""
    count = max(3, int((phase.end - phase.start) * CHECKING_RATE))
    times = np.linspace(phase.start, phase.end, count)
    speeds = ride.rates(times).of(place)
    change = np.linalg.norm(np.diff(speeds, axis=0), axis=1) / np.diff(times)
    if change.max() > MAX_ACCELERATION:
        frame = ride.ground.frame(float(times[change.argmax()]))
        name = ride.ground.thing.name
        raise JerkyGround(pin.name, name, frame, float(change.max()))
