"""Caps on contact forces under which the body would sink: found before anything is solved.

Where all forces are capped, the centre of mass accelerates downwards by at least gravity less the
peaks, in flight by gravity. Let q be that pull, integrated twice: z + q is concave, so it is at no
instant below the chord of two others. The floor bounds z from below, what touches bounds it from
above by how far the body reaches: where these leave no room no motion holds, however it goes.
What is not refused may be impossible all the same.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..body.character import Character
from ..body.kinematics import BodyPoint
from ..data.constants import STANDARD_GRAVITY
from ..data.faults import PeakTooLow
from ..data.requests import ForceRequest, Requests
from ..data.row_kinds import RowKind
from ..transcription.motion import Motion
from .evaluation_context import EvaluationContext, touches
from .far_apart import reach

SLACK = 0.05  # m: soles give, and limbs are let into the floor a little
INSTANTS = 65  # beside those at which contacts and caps begin and end
MOST, HALVINGS = 50.0, 12  # standard weights, up to which peaks are sought that may carry the body


@dataclass(frozen=True)
class _Cap:
    """A request's cap on the forces of some points, from start to end, s."""

    name: str
    peak: float
    points: frozenset[int]
    start: float
    end: float


def check_capped(requests: Requests, context: EvaluationContext, motion: Motion) -> None:
    """Refuses peaks that cannot carry the body, whatever it does. Raises PeakTooLow.

    motion: with the contacts at their places, on the new time; its poses do not count.
    """
    t = motion.transcription
    caps = [_cap(r, context, motion) for r in requests.forces if r.peak is not None]
    if not caps or not requests.solution.solid or t.support is not None:
        return  # nothing is capped, there is no floor, or something unseen carries as well
    lowest = min([context.schedule.floor_m, *motion.places[:, 2]])
    ends = [x for c in t.contacts for x in (c.contact.start, c.contact.end)]
    ends += [x for cap in caps for x in (cap.start, cap.end)]
    times = np.unique([*np.linspace(0.0, motion.duration, INSTANTS), *ends])
    times = times[(times >= 0.0) & (times <= motion.duration)]
    limits = [_limit(middle, caps, motion) for middle in 0.5 * (times[1:] + times[:-1])]
    push = np.array([most for most, _ in limits])
    room = _highest(times, motion) - lowest + SLACK
    let = len(caps) * RowKind.PEAK.tolerance

    def sinks(factor: float) -> BoolArray:
        pull = context.character.gravity - STANDARD_GRAVITY * (factor * push + let)
        return _sinks(times, pull, room)

    low, high = 1.0, max(1.0, MOST / min(cap.peak for cap in caps))
    if not sinks(low).any() or sinks(high).any():  # or it is not the peaks that are to blame
        return
    for _ in range(HALVINGS):
        middle = np.sqrt(low * high)
        low, high = (middle, high) if sinks(middle).any() else (low, middle)
    worst = int(np.flatnonzero(sinks(low))[0])  # there it touches, before or after
    cap = limits[worst][1] or limits[worst - 1][1] or caps[0]
    raise PeakTooLow(cap.name, cap.peak, float(cap.peak * low))


def _cap(request: ForceRequest, context: EvaluationContext, motion: Motion) -> _Cap:
    contacts = motion.transcription.contacts
    points = frozenset(c.point for c in contacts if touches(request.touching, c.contact))
    span = context.interval(request.name, request.when)
    return _Cap(request.name, request.peak or 0.0, points, *span)


def _limit(instant: float, caps: Sequence[_Cap], motion: Motion) -> tuple[float, _Cap | None]:
    """The most that all contacts may push with at an instant, s, standard weights; and the cap, or
    the lowest of those, that says so. Infinite where some force is not capped."""
    contacts = motion.transcription.contacts
    touching = {c.point for c in contacts if c.contact.start < instant < c.contact.end}
    here = [cap for cap in caps if cap.start < instant < cap.end]
    if not touching:
        return 0.0, None
    covers = [[cap] for cap in here if cap.points >= touching]
    if frozenset[int]().union(*(cap.points for cap in here)) >= touching:
        covers.append(here)
    sums = [sum(cap.peak for cap in cover) for cover in covers]
    if not sums:
        return np.inf, None
    lowest = int(np.argmin(sums))
    return sums[lowest], min(covers[lowest], key=lambda cap: cap.peak)


def _highest(times: FloatArray, motion: Motion) -> FloatArray:
    """(N,) m, that the centre of mass cannot be above; infinite where nothing still touches."""
    t = motion.transcription
    highest = np.full(len(times), np.inf)
    for contact, place in zip(t.contacts, motion.places, strict=True):
        if contact.held is None and contact.track is None and contact.ride is None:
            touching = (times >= contact.contact.start) & (times <= contact.contact.end)
            top = place[2] + _stretched(t.character, t.points[contact.point])
            highest[touching] = np.minimum(highest[touching], top)
    return highest


def _stretched(character: Character, point: BodyPoint) -> float:
    """Distance, m, of the centre of mass from a point of the body, all limbs stretched away."""
    ways = [
        body.mass * reach(character, point, BodyPoint(i, body.com))[1]
        for i, body in enumerate(character.bodies)
    ]
    return float(sum(ways) / character.mass)


def _sinks(times: FloatArray, pull: FloatArray, room: FloatArray) -> BoolArray:
    """(N,) the instants at which the body would be higher than `room` (N,) m above the floor, if it
    was above that before and after. pull: (N - 1,) m/s² downwards at least, minus infinity where
    that is not known."""
    found = np.zeros(len(times), dtype=bool)
    bounds = [0, *np.flatnonzero(np.isinf(pull)) + 1, len(times)]
    for start, stop in pairwise(bounds):
        if stop - start > 2:
            part = slice(start, stop)
            found[part] = _above(times[part], pull[start : stop - 1], room[part])
    return found


def _above(times: FloatArray, pull: FloatArray, room: FloatArray) -> BoolArray:
    """As `_sinks`, where the pull is known all the time."""
    steps = np.diff(times)
    speed = np.append(0.0, np.cumsum(pull * steps))
    sag = np.append(0.0, np.cumsum(speed[:-1] * steps + 0.5 * pull * steps**2))
    found = np.zeros(len(times), dtype=bool)
    for s in range(1, len(times) - 1):
        before, after = times[s] - times[:s, None], times[None, s + 1 :] - times[s]
        chords = (sag[:s, None] * after + sag[None, s + 1 :] * before) / (before + after)
        found[s] = chords.max() - sag[s] > room[s]
    return found
