"""Anticipation: what a performer does who knows that the landing has moved.

The flight takes as long as durations.py finds. A bigger jump is performed bigger: at the same mean
force the travel of the push grows with the energy that it gives, so the legs bend and the trunk
leans by (v'/v)² of what they did, v the upward speed at take-off; the push then takes v'/v as long.
Arms swing by the ratio of the whole speed, for they swing up and forward. Smaller jumps likewise.
Where no landing or take-off moves nothing changes.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from ..analysis.timeline import Stretch, TimeWarp
from ..arrays import FloatArray
from ..body.anatomy import Part
from ..data.contacts import ContactSchedule, Interval
from ..fitting.fit import LinearisedPoses
from ..inverse_kinematics.reseat import com_shift
from ..numerics.splines import THIRD_DERIVATIVE_WEIGHT, dense_instants, greville_abscissae
from ..transcription.motion import Motion
from .durations import TimedMotion, find_durations
from .warm_start import Standing, continuation_steps, stance_moves, warm_start

MIN_MOVE = 1e-6  # m, of a landing relative to its take-off
LEGS_AND_TRUNK = (Part.PELVIS, Part.SPINE, Part.THIGH, Part.SHANK, Part.FOOT, Part.TOE)
ARMS = (Part.CLAVICLE, Part.UPPER_ARM, Part.FOREARM, Part.HAND)  # head and neck look where they did
SPEED_RATIO = (0.7, 1.3)  # at most: beyond it, it is another kind of jump
MIN_RISING_SPEED = 0.3  # m/s; a slower take-off is no jump (a step, a drop)
MAX_STANDING_SPEED = 0.5  # m/s, along the floor; half of a slow walk's
MIN_DEPTH = 0.02  # m, of a crouch
STANDING_SHARE = 0.1  # of a crouch's depth, above which the body still stands
FALLEN_SHARE = 0.2  # of a crouch's depth; lower than this before it is another movement
MAX_STEPS = 4  # of continuation, 2 m: nobody jumps so much further or higher
MIN_LENGTH = 1.0 / 16.0  # of the way, of a step of continuation
SAMPLING_RATE = 240.0  # Hz


@dataclass(frozen=True)
class Jump:
    """A flight from a push: the body stands until `push`, then sinks and rises; s."""

    push: float
    take_off: float
    landing: float


@dataclass(frozen=True)
class Growth:
    """Ratios of the speeds of the centre of mass at take-off, new over old: upward and whole."""

    upward: float
    whole: float

    @staticmethod
    def between(was: FloatArray, now: FloatArray) -> "Growth":
        """was, now: (3,) m/s; 1 where it was no jump."""
        if was[2] <= MIN_RISING_SPEED:
            return Growth(1.0, 1.0)
        upward, whole = now[2] / was[2], np.linalg.norm(now) / np.linalg.norm(was)
        return Growth(float(np.clip(upward, *SPEED_RATIO)), float(np.clip(whole, *SPEED_RATIO)))


def changed_jumps(
    start: Motion, schedule: ContactSchedule, target: FloatArray, kept: tuple[Interval, ...]
) -> tuple[Jump, ...]:
    """The jumps that are longer or shorter with contacts at target (n_contacts, 3) m.

    A jump to a grip or from one is as long as it was recorded: grips move nothing. kept: intervals
    whose durations are to stay.
    """
    grips = [contact for contact in schedule.contacts if contact.asked_for]
    moves = stance_moves(schedule, Standing.still(start.places), Standing.still(target))
    return tuple(
        jump
        for jump in _jumps(start, schedule)
        if not _overlaps(jump.take_off, jump.landing, kept)
        and any(
            before.end <= jump.take_off
            and jump.landing <= after.start
            and not any(c.start < after.start and c.end > before.end for c in grips)
            and np.linalg.norm(after.shift - before.shift) > MIN_MOVE
            for before, after in pairwise(moves)
        )
    )


def anticipate(
    start: LinearisedPoses,
    schedule: ContactSchedule,
    target: FloatArray,
    kept: tuple[Interval, ...],
    jumps: tuple[Jump, ...],
) -> TimedMotion | None:
    """The motion as a performer would begin to change it for contacts at target (n_contacts, 3) m.

    jumps: those that change; at least one. None where no such motion is found.
    """
    before = start.motion.places
    standings = Standing.still(before), Standing.still(target)
    moves = tuple(move.straight for move in stance_moves(schedule, *standings))
    places = before.copy()
    for move in moves:
        for i, contact in enumerate(schedule.contacts):
            touches = contact.start < move.end and contact.end > move.start
            if touches and not contact.asked_for:
                places[i] = before[i] + move.shift
    near = continuation_steps(moves) <= MAX_STEPS
    found = _timed(start, schedule, places, jumps, MIN_LENGTH if near else 1.0)
    return None if found is None else _resized(start.motion, jumps, found, kept)


def _timed(
    start: LinearisedPoses,
    schedule: ContactSchedule,
    places: FloatArray,
    jumps: tuple[Jump, ...],
    shortest: float,
) -> TimedMotion | None:
    """The motion with contacts at places (n_contacts, 3) m and the flights' own durations.

    Found in steps, each from the motion and the durations that the one before found; of half the
    length where none are found. Most need no more than one. shortest: share of the way of a step.
    """
    first, poses = start.motion, start
    motion, stretches = first, tuple(Stretch(j.take_off, j.landing, 1.0) for j in jumps)
    done, length = 0.0, 1.0  # shares of the way
    while done < 1.0:
        warp = TimeWarp.of(stretches, first.duration)
        to = first.places + (done + length) * (places - first.places)
        standings = Standing.still(motion.places), Standing.still(to)
        moves = stance_moves(warp.schedule(schedule), *standings)
        carried = warm_start(motion, tuple(move.straight for move in moves))
        flights = [Interval(float(warp(j.take_off)), float(warp(j.landing))) for j in jumps]
        found = find_durations(poses, carried, to, flights)
        if found is None:
            length /= 2.0
            if length < shortest:
                return None
            continue
        done, motion = done + length, found.motion
        poses = LinearisedPoses(motion, start.price)
        stretches = tuple(
            replace(whole, factor=whole.factor * one.factor)
            for whole, one in zip(stretches, found.stretches, strict=True)
        )
    return TimedMotion(motion, stretches)


def _overlaps(start: float, end: float, intervals: Iterable[Interval]) -> bool:
    return any(each.start < end and each.end > start for each in intervals)


def _jumps(motion: Motion, schedule: ContactSchedule) -> Iterator[Jump]:
    """The flights that a push from standing begins.

    A bounce, as in a run, is none: it takes its energy from the flight before it and keeps its
    rhythm.
    """
    for flight in schedule.flights:
        if flight.start <= 0.0:
            continue  # its push is not in the range
        landed = max((f.end for f in schedule.flights if f.end < flight.start), default=0.0)
        times = np.arange(flight.start, landed, -1.0 / SAMPLING_RATE)
        height = motion.com(times)[:, 2]
        rising = np.append(np.diff(height) <= 0.0, False)  # backwards in time
        low = int(np.argmin(rising))
        times, height = times[low:], height[low:]
        top = np.maximum.accumulate(height)
        depth = top - height[0]
        sank = (depth > MIN_DEPTH) & (top - height > FALLEN_SHARE * depth)
        if landed > 0.0 and not sank.any():
            continue
        last = int(np.argmax(sank)) if sank.any() else len(height) - 1
        level = top[last] - STANDING_SHARE * depth[last]
        i = max(int(np.argmax(height >= level)), 1)
        stood = np.interp(level, height[i - 1 : i + 1], times[i - 1 : i + 1])
        speed = np.linalg.norm(motion.com(np.array([stood]), 1)[0, :2])
        if speed < MAX_STANDING_SPEED:
            yield Jump(float(stood), flight.start, flight.end)


# ---------------------------------------------------------------- amplitude


def _resized(
    start: Motion, jumps: tuple[Jump, ...], found: TimedMotion, kept: tuple[Interval, ...]
) -> TimedMotion:
    """The found motion with its pushes as much bigger, or smaller, as its flights are."""
    warp = TimeWarp.of(found.stretches, start.duration)
    growths = []
    for jump in jumps:
        was = start.com(np.array([jump.take_off]), 1)[0]
        now = found.motion.com(warp(np.array([jump.take_off])), 1)[0]
        growths.append(Growth.between(was, now))
    longer = tuple(
        Stretch(jump.push, jump.take_off, growth.upward)
        for jump, growth in zip(jumps, growths, strict=True)
        if not _overlaps(jump.push, jump.take_off, kept)
    )
    stretches = (*longer, *found.stretches)
    retimed = start.transcription.retimed(TimeWarp.of(stretches, start.duration))
    motion = Motion(retimed, found.motion.x, found.motion.places)
    for jump, growth in zip(jumps, growths, strict=True):
        motion = _amplified(start, motion, jump, growth)
    return TimedMotion(motion, stretches)


def _amplified(start: Motion, motion: Motion, jump: Jump, growth: Growth) -> Motion:
    """A motion with that take-off; what the arms began dies away in the flight.

    start: before any change, with the same unknowns.
    """
    t = motion.transcription
    standing = start.angles(np.array([jump.push]))[0]
    at = greville_abscissae(start.transcription.basis)
    swing = np.interp(at, [jump.take_off, jump.landing], [1.0, 0.0]) * (at >= jump.push)
    grown = dict.fromkeys(ARMS, (growth.whole - 1.0) * swing)
    grown |= dict.fromkeys(LEGS_AND_TRUNK, (growth.upward**2 - 1.0) * _crouch(start, jump, at))
    x = motion.x.copy()
    angles = x[:, t.layout.angles]
    for body, joint in zip(t.character.bodies, t.character.joints, strict=True):
        if body.part in grown:
            bend = angles[:, joint.dofs] - standing[joint.dofs]
            angles[:, joint.dofs] += grown[body.part][:, None] * bend
    x[:, t.layout.angles] = angles
    bent = replace(motion, x=x)
    times = dense_instants(t.basis)
    shift = com_shift(motion, bent.pose(times), t.points, times)
    x[:, t.layout.com] += t.basis.project(times, shift, THIRD_DERIVATIVE_WEIGHT)
    return bent


def _crouch(motion: Motion, jump: Jump, times: FloatArray) -> FloatArray:
    """(T,) depth of the centre of mass below standing over its greatest, during a push.

    Who jumps further bends further, but straightens as far as before.
    """
    height = motion.com(np.clip(times, jump.push, jump.take_off))[:, 2]
    depth = np.maximum(height[0] - height, 0.0)
    return np.asarray(depth / max(float(depth.max()), MIN_DEPTH))
