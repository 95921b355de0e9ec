"""Anticipation: what a performer does who knows that the landing has moved.

The flight takes as long as durations.py finds. A bigger jump is performed bigger: at the same mean
force the travel of the push grows with the energy that it gives, so the legs bend and the trunk
leans by (v'/v)² of what they did, v the upward speed at take-off; the push then takes v'/v as long.
Arms swing with the speed of the body, so by v'/v as far. Smaller jumps likewise. Where no landing
or take-off moves nothing changes.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from ..arrays import FloatArray
from ..body.anatomy import Part
from ..data.contacts import ContactSchedule, Interval
from ..data.timeline import Stretch, TimeWarp
from ..transcription.motion import Motion
from .durations import TimedMotion, find_durations
from .fit import THIRD_DERIVATIVE_WEIGHT, dense_instants, greville_abscissae
from .reseat import com_shift
from .warm_start import stance_moves, warm_start

MIN_MOVE = 1e-6  # m, of a landing relative to its take-off
SCALED_PARTS = {
    **dict.fromkeys((Part.PELVIS, Part.SPINE, Part.THIGH, Part.SHANK, Part.FOOT, Part.TOE), 2),
    **dict.fromkeys((Part.CLAVICLE, Part.UPPER_ARM, Part.FOREARM, Part.HAND), 1),
}  # powers of v'/v; head and neck look where they did
SPEED_RATIO = (0.7, 1.3)  # at most: beyond it, it is another kind of jump
MIN_RISING_SPEED = 0.3  # m/s; a slower take-off is no jump (a step, a drop)
MIN_DEPTH = 0.02  # m, of a crouch
STANDING_SHARE = 0.1  # of a crouch's depth, above which the body still stands
FALLEN_SHARE = 0.2  # of a crouch's depth; lower than this before it is another movement
SAMPLING_RATE = 240.0  # Hz


@dataclass(frozen=True)
class Push:
    """A push before a flight: from `start`, where the body begins to sink, to `end`, take-off; s.

    ratio: v'/v, of the upward speeds at take-off.
    """

    start: float
    end: float
    landing: float
    ratio: float


def anticipate(
    start: Motion, schedule: ContactSchedule, target: FloatArray, kept: tuple[Interval, ...]
) -> TimedMotion | None:
    """The motion as a performer would begin to change it for contacts at target (n_contacts, 3) m.

    kept: intervals whose durations are to stay. None where no flight changes, or no such motion is
    found.
    """
    moves = tuple(replace(move, turn=0.0) for move in stance_moves(schedule, start.places, target))
    flights = [
        flight
        for before, after in pairwise(moves)
        for flight in schedule.flights
        if (before.end, after.start) == (flight.start, flight.end)
        and np.linalg.norm(after.shift - before.shift) > MIN_MOVE
        and not _overlaps(flight.start, flight.end, kept)
    ]
    if not flights:
        return None
    places = start.places.copy()
    for move in moves:
        for i, contact in enumerate(schedule.contacts):
            touches = contact.start < move.end and contact.end > move.start
            if touches and not contact.asked_for:
                places[i] = start.places[i] + move.shift
    found = find_durations(start, warm_start(start, moves), places, flights)
    return None if found is None else _grown(start, schedule, found, kept)


def _overlaps(start: float, end: float, intervals: Iterable[Interval]) -> bool:
    return any(each.start < end and each.end > start for each in intervals)


# ---------------------------------------------------------------- amplitude


def _grown(
    start: Motion, schedule: ContactSchedule, found: TimedMotion, kept: tuple[Interval, ...]
) -> TimedMotion:
    """The found motion with its pushes as much bigger, or smaller, as its flights are."""
    warp = TimeWarp.of(found.stretches, start.duration)
    pushes = []
    for flight in found.stretches:
        push_start = _push_start(start, schedule, flight.start)
        was = _take_off_speed(start, flight.start)
        now = _take_off_speed(found.motion, float(warp(flight.start)))
        if push_start is None or was < MIN_RISING_SPEED:
            continue
        ratio = float(np.clip(now / was, *SPEED_RATIO))
        pushes.append(Push(push_start, flight.start, flight.end, ratio))
    longer = tuple(
        Stretch(push.start, push.end, push.ratio)
        for push in pushes
        if not _overlaps(push.start, push.end, kept)
    )
    stretches = (*longer, *found.stretches)
    new = start.transcription.retimed(TimeWarp.of(stretches, start.duration))
    motion = Motion(new, found.motion.x, found.motion.places)
    for push in pushes:
        motion = _amplified(start, motion, push)
    return TimedMotion(motion, stretches)


def _take_off_speed(motion: Motion, take_off: float) -> float:
    """Upward speed of the centre of mass, m/s, at the end of a ground phase, s."""
    return float(motion.com(np.array([take_off]), 1)[0, 2])


def _push_start(motion: Motion, schedule: ContactSchedule, take_off: float) -> float | None:
    """The instant, s, at which a body that stood begins to sink for a jump.

    None where it does not stand before: a bounce takes its energy from the flight before it.
    """
    begin = max((f.end for f in schedule.flights if f.end < take_off), default=0.0)
    times = np.arange(take_off, begin, -1.0 / SAMPLING_RATE)
    height = motion.com(times)[:, 2]
    if (np.diff(height) > 0.0).any():  # backwards in time: the last of the sinking
        low = int(np.argmax(np.diff(height) > 0.0))
        times, height = times[low:], height[low:]
    top = np.maximum.accumulate(height)
    depth = top - height[0]
    sank = (depth > MIN_DEPTH) & (top - height > FALLEN_SHARE * depth)
    end = int(np.argmax(sank)) if sank.any() else len(height)
    stood = np.flatnonzero(height[:end] > top[end - 1] - STANDING_SHARE * depth[end - 1])
    starts = float(times[stood[0]])
    return starts if depth[end - 1] > MIN_DEPTH and (begin == 0.0 or sank.any()) else None


def _amplified(start: Motion, motion: Motion, push: Push) -> Motion:
    """A motion whose push is `ratio` as fast. start: before any change, with the same unknowns."""
    t = motion.transcription
    standing = start.angles(np.array([push.start]))[0]
    at = greville_abscissae(start.transcription.basis)
    fading = np.interp(at, [push.end, push.landing], [1.0, 0.0]) * (at >= push.start)
    x = motion.x.copy()
    angles = x[:, t.layout.angles]
    for body, joint in zip(t.character.bodies, t.character.joints, strict=True):
        growth = (push.ratio ** SCALED_PARTS.get(body.part, 0) - 1.0) * fading[:, None]
        bend = growth * (angles[:, joint.dofs] - standing[joint.dofs])
        if joint.axes.dofs == 1:  # a hinge bends further, but straightens as far as it did
            most = bend.flat[np.abs(bend).argmax()]
            bend = np.where(bend * most > 0.0, bend, 0.0)
        angles[:, joint.dofs] += bend
    x[:, t.layout.angles] = angles
    bent = replace(motion, x=x)
    times = dense_instants(t.basis)
    shift = com_shift(motion, bent.pose(times), t.points, times)
    x[:, t.layout.com] += t.basis.project(times, shift, THIRD_DERIVATIVE_WEIGHT)
    return bent
