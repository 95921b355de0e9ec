"""Time warp from recording to adapted motion: retimed phases, held frames (thesis 6.2, 6.3).

The map is piecewise linear: a phase that takes longer stretches, a held frame opens a gap in which
the old time stands still.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np

from ..arrays import FloatArray
from ..data.contacts import ContactSchedule, Interval, Phase, is_phase_name, numbers_of
from ..data.faults import (
    BadTiming,
    BesideFrames,
    BesidePhase,
    NamedAsPhase,
    TimedTwice,
    TooMuchTime,
    UnknownPhaseIn,
)
from ..data.requests import Hold, Moment, PhaseTiming, When

MIN_PHASE_DURATION = 0.03  # s
HOLD_EASING_TIME = 0.2  # s; half-width of the moving average around a hold
MOST_ADDED = 30.0  # s; a solve of so much more takes half a minute and over a GB
TIME_DECIMALS = 9  # instants, s, are rounded to, so that those that are one stay one


@dataclass(frozen=True)
class NamedInterval:
    """A time interval [start, end], s, with a name."""

    name: str
    start: float
    end: float


@dataclass(frozen=True)
class Stretch:
    """An interval [start, end], s, that takes `factor` times as long."""

    start: float
    end: float
    factor: float


@dataclass(frozen=True)
class TimeWarp:
    """Piecewise linear map of instants by stretches. old, new: (T,) s, its corners."""

    old: FloatArray
    new: FloatArray

    @staticmethod
    def of(stretches: Sequence[Stretch], duration: float) -> "TimeWarp":
        """The map of [0, duration] s by stretches that do not overlap."""
        edges = {t for each in stretches for t in (each.start, each.end)}
        old = np.array(sorted({0.0, duration, *edges}))
        middles = 0.5 * (old[:-1] + old[1:])
        rate = np.ones(len(middles))
        for each in stretches:
            rate[(each.start < middles) & (middles < each.end)] = each.factor
        return TimeWarp(old, np.concatenate([[0.0], np.cumsum(rate * np.diff(old))]))

    def __call__(self, times: FloatArray | float) -> FloatArray:
        """New instants (...), s, of old ones."""
        return np.round(np.interp(times, self.old, self.new), TIME_DECIMALS)

    def inverse(self, times: FloatArray | float) -> FloatArray:
        """Old instants (...), s, of new ones."""
        return np.asarray(np.interp(times, self.new, self.old))

    def schedule(self, schedule: ContactSchedule) -> ContactSchedule:
        """A schedule at the new instants."""
        contacts = tuple(
            replace(c, start=float(self(c.start)), end=float(self(c.end)))
            for c in schedule.contacts
        )
        unseen = tuple(Interval(float(self(u.start)), float(self(u.end))) for u in schedule.unseen)
        duration = float(self(schedule.duration))
        return replace(schedule, contacts=contacts, unseen=unseen, duration=duration)


@dataclass(frozen=True)
class Timeline:
    """Piecewise linear time warp.

    old, new: (T,) s, its corners, both ascending. holds: inserted intervals, in new time.
    first_frame: scene frame of old time 0. rate: scene frames a second.
    """

    old: FloatArray
    new: FloatArray
    holds: tuple[NamedInterval, ...]
    first_frame: float
    rate: float

    @property
    def duration(self) -> float:
        """Duration of the adapted motion, s."""
        return float(self.new[-1])

    @cached_property
    def unchanged(self) -> bool:
        """Whether the map is the identity."""
        return len(self.holds) == 0 and bool(np.allclose(self.old, self.new))

    def to_new(self, old: FloatArray | float) -> FloatArray:
        """New instants (...), s, of old ones; a held frame's is the beginning of its hold."""
        apart = self.old + 1e-12 * np.arange(len(self.old))
        return np.round(np.interp(old, apart, self.new), TIME_DECIMALS)

    def to_old(self, new: FloatArray | float) -> FloatArray:
        """Old instants (...), s, of new ones."""
        return np.asarray(np.interp(new, self.new, self.old))

    def warped(self, warp: TimeWarp) -> "Timeline":
        """This map, and then another of its new time."""
        corners = np.setdiff1d(warp.old, self.new)
        new = np.concatenate([self.new, corners])
        old = np.concatenate([self.old, self.to_old(corners)])
        order = np.argsort(new, kind="stable")
        holds = tuple(
            replace(hold, start=float(warp(hold.start)), end=float(warp(hold.end)))
            for hold in self.holds
        )
        return replace(self, old=old[order], new=warp(new[order]), holds=holds)

    def eased(self, new: FloatArray) -> FloatArray:
        """Old instants (N,), s, as `to_old`, but gliding into holds and out of them.

        A moving average over HOLD_EASING_TIME to both sides (less near the ends) with parabolic
        (Epanechnikov) weights.
        """
        if not self.holds:
            return self.to_old(new)
        share = np.linspace(-1.0, 1.0, 21)
        weight = 1.0 - share**2
        reach = np.minimum(HOLD_EASING_TIME, np.minimum(new, self.duration - new))
        around = new[:, None] + share * np.maximum(reach, 0.0)[:, None]
        return np.asarray(self.to_old(around) @ (weight / weight.sum()))

    def instant(self, frame: float) -> float:
        """New time, s, of a scene frame of the recording."""
        return float(self.to_new((frame - self.first_frame) / self.rate))

    def schedule(self, schedule: ContactSchedule) -> ContactSchedule:
        """The schedule in new time; contacts after the end are dropped."""
        moved = []
        for contact in schedule.contacts:
            start, end = (float(self.to_new(t)) for t in (contact.start, contact.end))
            if contact.end >= self.old[-1] - 1e-9:  # also through a hold of the last frame
                end = self.duration
            if contact.start < self.old[-1] - 1e-9 and end > start:
                moved.append(replace(contact, start=start, end=end))
        spans = [(float(self.to_new(u.start)), float(self.to_new(u.end))) for u in schedule.unseen]
        unseen = tuple(Interval(start, end) for start, end in spans if end > start)
        left = (phase for phase in schedule.phases if phase.start < self.old[-1] - 1e-9)
        return replace(
            schedule,
            contacts=tuple(moved),
            duration=self.duration,
            unseen=unseen,
            numbers=numbers_of(left),
        )


def timeline(
    schedule: ContactSchedule,
    first_frame: float,
    rate: float,
    timings: Sequence[PhaseTiming],
    holds: Sequence[Hold],
) -> Timeline:
    """Time warp from new phase durations and held frames.

    schedule: of the recording. Raises UnknownPhaseIn, BadTiming, BesideFrames, NamedAsPhase,
    TimedTwice, TooMuchTime.
    """
    phases = {phase.name: phase for phase in schedule.phases}
    wanted: dict[str, float] = {}
    for timing in timings:
        phase = _known(timing.name, timing.phase, phases)
        length = phase.end - phase.start
        factor = 1.0 if timing.factor is None else timing.factor
        seconds = length * factor if timing.seconds is None else timing.seconds
        if seconds < MIN_PHASE_DURATION:
            raise BadTiming(timing.name, seconds)
        if timing.phase in wanted:
            raise TimedTwice(timing.name, timing.phase)
        wanted[timing.phase] = seconds
    edges = sorted({0.0, schedule.duration, *(p.end for p in phases.values())})
    stops: dict[float, list[Hold]] = {}
    for hold in holds:
        if is_phase_name(hold.name):  # of another clip's too: edits are made for several
            raise NamedAsPhase(hold.name)
        at = (hold.frame - first_frame) / rate
        at = next((edge for edge in edges if abs(edge - at) < 1e-6), at)
        if not 0.0 < at <= schedule.duration:
            last_frame = first_frame + schedule.duration * rate
            raise BesideFrames(hold.name, hold.frame, first_frame, last_frame)
        if hold.seconds < MIN_PHASE_DURATION:
            raise BadTiming(hold.name, hold.seconds)
        stops.setdefault(at, []).append(hold)
    _check_added(
        [(wanted[t.phase] - phases[t.phase].end + phases[t.phase].start, t.name) for t in timings]
        + [(hold.seconds, hold.name) for hold in holds]
    )
    corners = sorted({*edges, *stops})
    old, new, named = [0.0], [0.0], []
    for start, end in pairwise(corners):
        middle = 0.5 * (start + end)
        inside = next(p for p in phases.values() if p.start <= middle <= p.end)
        length = inside.end - inside.start
        old.append(end)
        longer = wanted.get(inside.name, length) / length
        new.append(round(new[-1] + (end - start) * longer, TIME_DECIMALS))
        for hold in stops.get(end, []):
            old.append(end)
            new.append(round(new[-1] + hold.seconds, TIME_DECIMALS))
            named.append(NamedInterval(hold.name, new[-2], new[-1]))
        if any(hold.ends for hold in stops.get(end, [])):
            break
    return Timeline(np.array(old), np.array(new), tuple(named), first_frame, rate)


def _check_added(gains: Sequence[tuple[float, str]]) -> None:
    """Whether a solve has room for what is added: s, by the names of those that ask for it.

    Raises TooMuchTime, of the one that adds most.
    """
    seconds = sum(gain for gain, _ in gains)
    if seconds > MOST_ADDED:
        raise TooMuchTime(max(gains)[1], seconds, MOST_ADDED)


def _known(name: str, phase: str, phases: dict[str, Phase]) -> Phase:
    """The phase called `phase`. Raises UnknownPhaseIn."""
    if phase not in phases:
        raise UnknownPhaseIn(name, phase, tuple(phases))
    return phases[phase]


def active_interval(
    name: str, when: When, line: Timeline, phases: Sequence[Phase], apex: FloatArray
) -> tuple[float, float]:
    """Start and end, s, in new time, of when a request holds; equal for a single instant.

    phases: in new time. apex: (T, 2) instants, s, and heights, m, of the centre of mass.
    Raises UnknownPhaseIn, BadTiming, BesideFrames, BesidePhase.
    """
    start, end = 0.0, line.duration
    if when.phase is not None:
        known = [*(NamedInterval(p.name, p.start, p.end) for p in phases), *line.holds]
        found = [each for each in known if each.name == when.phase]
        if not found:
            raise UnknownPhaseIn(name, when.phase, tuple(each.name for each in known))
        start, end = found[-1].start, found[-1].end
    if when.frames is not None:
        first, last = (line.instant(frame) for frame in when.frames)
        shown = float(line.first_frame + line.rate * line.old[-1])
        if when.frames[0] > shown + 0.5:
            raise BesideFrames(name, when.frames[0], line.first_frame, shown)
        if when.frames[1] < line.first_frame - 0.5:
            raise BesideFrames(name, when.frames[1], line.first_frame, shown)
        start, end = max(start, first), min(end, last)
        if end < start and when.phase is not None:
            raise BesidePhase(name, when.phase, *when.frames)
    if end < start:
        raise BadTiming(name, end - start)
    if when.moment is None:
        return start, end
    at = moment_within(when.moment, start, end, apex)
    if at is None:
        raise BadTiming(name, end - start)
    return at, at


def moment_within(moment: Moment, start: float, end: float, heights: FloatArray) -> float | None:
    """The instant that a moment of [start, end] is, in any unit of time.

    heights: (T, 2) instants and heights of the centre of mass, of which the highest is the apex;
    None where no instant of them lies within.
    """
    match moment:
        case Moment.START:
            return start
        case Moment.END:
            return end
        case Moment.MIDDLE:
            return 0.5 * (start + end)
    inside = (heights[:, 0] >= start) & (heights[:, 0] <= end)
    if not inside.any():
        return None
    return float(heights[inside][np.argmax(heights[inside, 1]), 0])
