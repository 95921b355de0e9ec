"""Wording of what is asked of a motion and is legal, but hardly meant."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from math import degrees, tau
from typing import Protocol

import numpy as np

from ...solver.analysis.grounding import Stray
from ...solver.analysis.leaps import Leap
from ...solver.arrays import FloatArray
from ...solver.data.constants import STANDARD_GRAVITY
from ...solver.data.contacts import Phase, PhaseKind
from ...solver.data.problem import MotionProblem, OffsetAxes
from ...solver.data.requests import AddedMass, PhaseTiming, When
from ...solver.data.scene import SceneObject
from .messages import length

A_FRAME = 1.0
MOST_CARRIED = 1.0  # body masses; a weightlifter moves more, but does not jump with it
LONGEST_ARM = 2.0  # m from a bone to what it carries
MOST_GRAVITY, LEAST_GRAVITY = 25.0, 0.2  # m/s², Jupiter's, and that of the largest asteroids
LONGEST, SHORTEST = 4.0, 0.25  # times a phase's duration
LARGEST, SMALLEST = 3.0, 0.3  # times a limb
MOST_FRICTION = 3.0  # of rubber on dry concrete it is 1
MOST_TORQUE, MOST_SHARE = 1000.0, 5.0  # N·m, of the strongest hips twice; times the recording's
MOST_SPEED = 30.0  # m/s, of an express train's roof
MOST_SLACK = 0.1  # m that a contact may miss its place by
MOST_STRAY = 0.3  # m; feet that slide or roll while they stand go by a third of it
ROUNDING = 1e-6  # rad, of degrees in a recipe
SAME = 0.01  # m; a leap that differs by less is as recorded

# Of jumps on the Earth, by what is jumped with its speed at the take-off: lengths grow as gravity
# falls.
MOST_RISE = 1.5  # m that the body rises in flight, of tumblers; of standing jumps 1.2
MOST_UP = 1.7  # m, the highest box that was jumped onto from standing
MOST_DOWN = 2.5  # m, from which trained people land on their feet
FARTHEST = 3.7  # m, the longest standing long jump
STANDING = 0.5  # m/s, of a figure that sways
RUN_UP = 0.5  # s: m more for each m/s of run-up; the longest long jump goes 8.95 m from 11 m/s


class _Timed(Protocol):
    """A request of some frames, or all."""

    @property
    def name(self) -> str: ...

    @property
    def when(self) -> When: ...


def request_doubts(
    problem: MotionProblem, phases: Sequence[Phase], leaps: Sequence[Leap]
) -> list[str]:
    """A line for each. phases, leaps: of the recording."""
    return [
        *_of_gravity(problem.requests.body.gravity),
        *_of_loads(problem),
        *_of_limbs(problem),
        *_of_timings(problem, phases),
        *_of_turns(problem),
        *_of_leaps(problem, leaps),
        *_of_limits(problem),
        *_of_speeds(problem.scene),
    ]


def beyond_doubts(problem: MotionProblem, frames: Sequence[float] | FloatArray) -> list[str]:
    """A line for each request whose range of frames goes beyond those (T,) that are adapted; what
    is all beside them is refused, and where there are no frames these do not tell."""
    if not len(frames):
        return []
    first, last = float(frames[0]), float(frames[-1])
    r = problem.requests
    limits: tuple[_Timed, ...] = (*r.angles, *r.cones, *r.twists, *r.torques, *r.forces)
    timed: tuple[_Timed, ...] = (*r.points, *limits, *r.poses, *r.orientations)
    return [
        f"“{each.name}” is about frames {span[0]:.9g} to {span[1]:.9g}, but the adapted frames are "
        f"{first:g} to {last:g}, and it holds in these alone"
        for each in timed
        if (span := each.when.frames) is not None
        and (span[0] < first - A_FRAME or last + A_FRAME < span[1])
        and (first <= span[1] and span[0] <= last)
    ]


def direction_doubts(problem: MotionProblem, backwards: Collection[str]) -> list[str]:
    """A line where pins move what lands backwards along its travel. backwards: the ground phases
    whose forward is at the body's back."""
    names = [
        pin.name
        for pin in problem.pins
        if pin.phase in backwards and pin.axes is OffsetAxes.TRAVEL and any(pin.offset[:2])
    ]
    return [f"{quoted(names)}: forward is the way it travels, at the body's back"] if names else []


def contact_doubts(
    strays: Iterable[Stray], factor: float, frame_at: Callable[[float], float]
) -> list[str]:
    """A line for each contact of the artist's that lasts while its point is elsewhere.

    strays: theirs, in true lengths. factor: of these to those as recorded. frame_at: the scene's
    frame at an instant, s.
    """
    return [
        f"“{each.contact.name}” lasts while the recording has its point "
        f"{length(factor * each.away)} from where it touches (frame {frame_at(each.when):.0f}): "
        "where no motion holds it there, it will be let go. Let it last for as long as the point "
        "stands"
        for each in strays
        if each.away > MOST_STRAY
    ]


def _of_gravity(gravity: float) -> Iterator[str]:
    if gravity > MOST_GRAVITY:
        yield f"Gravity is {gravity:g} m/s², more than on any planet; the Earth's is 9.81"
    if gravity < LEAST_GRAVITY:
        yield f"Gravity is {gravity:g} m/s², in which a jump takes minutes; the Moon's is 1.62"


def _of_loads(problem: MotionProblem) -> Iterator[str]:
    loads = problem.requests.body.added
    mass = problem.requests.body.mass or problem.mass
    carried = sum(_share(load, mass) for load in loads)
    if carried > MOST_CARRIED:
        names = quoted(load.name for load in loads)
        yield f"{names}: {carried:.3g} times the body's own mass, with which nobody jumps"
    for load in loads:
        away = float(np.linalg.norm(load.offset or (0.0, 0.0, 0.0)))
        if away > LONGEST_ARM:
            yield f"“{load.name}” is {length(away)} from “{load.bone}”, which carries it"


def _share(load: AddedMass, mass: float) -> float:
    return (load.share or 0.0) if load.mass is None else load.mass / mass


def _of_limbs(problem: MotionProblem) -> Iterator[str]:
    for limb in problem.requests.body.limbs:
        changes = {"long": limb.length, "heavy": limb.mass}
        for how, factor in changes.items():
            if not SMALLEST <= factor <= LARGEST:
                yield f"“{limb.name}” makes {quoted(limb.bones)} {factor:g} times as {how}"
    for shape in problem.requests.shapes:
        if shape.thickness > LARGEST:
            yield f"“{shape.name}” makes {quoted(shape.bones)} {shape.thickness:g} times as thick"


def _of_timings(problem: MotionProblem, phases: Sequence[Phase]) -> Iterator[str]:
    named = {phase.name: phase for phase in phases}
    for timing in problem.requests.timings:
        if (phase := named.get(timing.phase)) is not None:  # else the solve refuses it
            yield from _of_timing(timing, phase, problem.requests.body.gravity)


def _of_timing(timing: PhaseTiming, phase: Phase, gravity: float) -> Iterator[str]:
    recorded = phase.end - phase.start
    factor = 1.0 if timing.factor is None else timing.factor
    seconds = recorded * factor if timing.seconds is None else timing.seconds
    told = f"“{timing.name}” lets {phase.name} last {seconds:.3g} s (recorded: {recorded:.2f} s)"
    rise, most = gravity * seconds**2 / 8.0, highest(gravity)
    if phase.kind is PhaseKind.FLIGHT and seconds > recorded:
        if rise > most:
            yield (
                f"{told}, for which the body must rise by {rise:.3g} m; nobody{there(gravity)} "
                f"jumps higher than {length(most)}"
            )
    elif not SHORTEST <= seconds / recorded <= LONGEST:
        yield f"{told}, {seconds / recorded:.3g} times as long"


def _of_turns(problem: MotionProblem) -> Iterator[str]:
    wound = [pin for pin in problem.pins if abs(pin.turn) > tau + ROUNDING]
    for phase, turn in dict.fromkeys((pin.phase, pin.turn) for pin in wound):
        names = [pin.name for pin in wound if (pin.phase, pin.turn) == (phase, turn)]
        turns = "turns" if len(names) == 1 else "turn"
        yield (
            f"{quoted(names)} {turns} {phase} by {degrees(turn):.0f}°, and the body has to make "
            f"all of these {abs(turn) / tau:.3g} turns on its way there"
        )
    for asked in problem.requests.orientations:
        for angle in (asked.turn, asked.tilt):
            if abs(angle) > tau - ROUNDING:
                same = round(degrees(angle - tau * round(angle / tau)))
                yield f"“{asked.name}” asks for {degrees(angle):.0f}°, which is {same}°"


def _of_leaps(problem: MotionProblem, leaps: Sequence[Leap]) -> Iterator[str]:
    gravity = problem.requests.body.gravity
    for leap in leaps:
        pins = [pin.name for pin in problem.pins if pin.phase in (leap.take_off, leap.landing)]
        told = "; ".join(_far(leap, gravity))
        if told:
            names = f"{quoted(pins)}: " if pins else ""
            yield f"{names}{leap.landing} would be {told}"


def _far(leap: Leap, gravity: float) -> Iterator[str]:
    """What of a leap is more than anybody jumps."""
    scale, nobody = STANDARD_GRAVITY / gravity, f"nobody{there(gravity)}"
    up, was_up = float(leap.asked[2]), float(leap.recorded[2])
    far, was_far = (float(np.hypot(*way[:2])) for way in (leap.asked, leap.recorded))
    most_up, most_down = scale * MOST_UP, scale * MOST_DOWN
    farthest = scale * (FARTHEST + RUN_UP * leap.run_up) + max(-up, 0.0)
    if up > max(most_up, was_up + SAME):
        yield (
            f"{length(up)} above {leap.take_off}, and {nobody} jumps onto more than "
            f"{length(most_up)}"
        )
    if up < min(-most_down, was_up - SAME):
        yield (
            f"{length(-up)} below {leap.take_off}, and {nobody} jumps down more than "
            f"{length(most_down)}"
        )
    if far > max(farthest, was_far + SAME):
        yield (
            f"{length(far)} from {leap.take_off}, and {nobody} jumps farther than "
            f"{length(farthest)} {_from(leap.run_up)}"
        )


def _from(run_up: float) -> str:
    return f"from a run-up at {run_up:.1f} m/s" if run_up > STANDING else "from standing"


def there(gravity: float) -> str:
    """Which gravity a limit is for, where that is not the Earth's."""
    return "" if gravity == STANDARD_GRAVITY else " at this gravity"


def _of_limits(problem: MotionProblem) -> Iterator[str]:
    for force in problem.requests.forces:
        if force.friction is not None and force.friction > MOST_FRICTION:
            yield (
                f"“{force.name}” asks for a friction of {force.friction:g}, which no ground has; "
                "rubber on concrete has 1"
            )
    for limit in problem.requests.torques:
        if limit.bound is not None and limit.bound > MOST_TORQUE:
            yield f"“{limit.name}” allows {limit.bound:g} N·m, more than anybody has"
        if limit.share is not None and limit.share > MOST_SHARE:
            yield (
                f"“{limit.name}” allows {limit.share:g} times the recording's peak, so it limits "
                "nothing"
            )
    most = highest(problem.requests.body.gravity)
    for clear in problem.requests.clears:
        if clear.by > most:
            yield f"“{clear.name}” asks for a way {length(clear.by)} above “{clear.thing}”"
    if problem.good_enough > MOST_SLACK:
        yield f"Contacts may be {length(problem.good_enough)} off their places and are good enough"


def _of_speeds(scene: Sequence[SceneObject]) -> Iterator[str]:
    for thing in scene:
        if thing.steady is None:
            continue
        speed = max(float(np.linalg.norm(v)) for v in (thing.steady.velocity, thing.steady.belt))
        if speed > MOST_SPEED:
            yield f"“{thing.name}” moves at {speed:g} m/s, from which and to which nobody jumps"


def highest(gravity: float) -> float:
    """M that a body can rise."""
    return MOST_RISE * STANDARD_GRAVITY / gravity


def quoted(names: Iterable[str]) -> str:
    """The names in quotation marks, one after the other."""
    return ", ".join(f"“{name}”" for name in names)
