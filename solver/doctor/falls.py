"""How fast a body falls whose feet are up: the clock's and the ruler's scale in one number.

Lengths that are s times and durations that are t times what they were make of gravity g s / t².
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..analysis.carried_by import is_held_in
from ..analysis.performance import Performance, contact_points, leans
from ..arrays import BoolArray, FloatArray
from ..data.constants import STANDARD_GRAVITY
from ..numerics.runs import runs
from ..scene.fall_rate import usual_rates
from .finding import Finding, FindingKind
from .repairs import Repairs

CLEAR = 0.02  # of the height, by which all points of the feet are up
FEWEST = 6  # frames of a fall
SHORTEST = 0.06  # s, at the recording's own clock, or as much as that many frames
ROUGH = 0.03  # of the fall's height, rms, by which it may miss a parabola, and
ROUGH_BY = 0.002  # of the figure's height, than which its arc is higher: a straight way misses less
DOWNWARDS = 0.7  # of a fall's acceleration; a camera 45° off the level has it upright
OFF = 0.12  # of a scale of time; a run's short flights are 5 % off in honest recordings
SURE = 2.0  # times a fall's uncertainty; clean clips from 30 Hz on are within 1.1
USUAL_NEAR, PRECISE_FALL = 0.035, 0.35  # a fall of 0.35 s tells the rate to 3.5 %, half of it 7 %
# A wrong size is mostly a wrong unit: metres, centimetres, millimetres, inches, feet.
UNITS = (1.0, 0.01, 0.001, 0.0254, 0.3048)  # m
WRITTEN = (1.0, 0.01, 0.001, 0.0254)  # m; units in which files are, taken for metres
UNIT_RATIOS = tuple(
    sorted({float(f"{one / other:.12g}") for one in UNITS for other in UNITS if one != other})
)
CLEARLY = 1.5  # times nearer than the next ratio
HEIGHTS = (1.1, 2.1)  # m; persons; others are read at a wrong scale
USUAL_HEIGHT = 1.75  # m
AGREE = 3.0  # times a fall's uncertainty, by which honest ones miss the rest
MOST = 2.0 / 3.0  # of the falls, and of their weight, must agree: others may be none
LEAP = 3.0  # g, downwards, of the centre of mass; honest recordings have 1.0 to 1.8
LEAP_WINDOW, LEAP_FRAMES = 0.05, 2  # s, on each side, and frames at least


@dataclass(frozen=True)
class Falls:
    """acceleration: m/s², over all. longest: s. frames: (first, last) scene frames of each."""

    acceleration: float
    longest: float
    frames: tuple[tuple[float, float], ...]


Spans = tuple[tuple[float, float], ...]
"""First and last scene frames of each."""


@dataclass(frozen=True)
class Trusted:
    """Which falls tell a clock. fewest: frames of one. but: where frames are held or missing, or
    something unseen carries the body: those that touch them may be cut, and are not the clock's.
    carried: where contacts that are stated do, none is a fall."""

    fewest: int = FEWEST
    but: Spans = ()
    carried: Spans = ()

    def holds(self, count: int, span: tuple[float, float]) -> bool:
        """Whether one of so many frames, from the first to the last of a span, does."""
        near = span[0] - 1.0, span[1] + 1.0
        return count >= self.fewest and not (meets(near, self.but) or meets(span, self.carried))


ALL = Trusted()


def meets(span: tuple[float, float], others: Spans) -> bool:
    """Whether a span shares a frame with one of others."""
    return any(a <= span[1] and span[0] <= b for a, b in others)


def falls_of(performance: Performance, trusted: Trusted = ALL) -> Falls | None:
    """The falls of a recording that are trusted; None where there are none that are parabolas, or
    they do not agree."""
    found, spans = each_fall(performance, trusted)
    return _agreed(found, spans) if spans else None


def each_fall(performance: Performance, trusted: Trusted = ALL) -> tuple[FloatArray, Spans]:
    """(N, 2) accelerations, m/s², and durations, s, of those that are trusted and are
    parabolas, in which nothing holds the body, and their scene frames."""
    up, height = in_the_air(performance), performance.character.height
    times, com, frames = performance.times, performance.com[:, 2], performance.recording.frames
    found, spans = [], []
    for first, last in runs(up):
        cut_off = first == 0 or last == len(up) - 1
        span = float(frames[first]), float(frames[last])
        short = times[last] - times[first] < SHORTEST
        if cut_off or short or not trusted.holds(last - first + 1, span):
            continue
        clock, path = times[first : last + 1] - times[first], com[first : last + 1]
        curve = np.polyfit(clock, path, 2)
        missed = float(np.sqrt(np.mean((path - np.polyval(curve, clock)) ** 2)))
        acceleration = _acceleration(clock, performance.com[first : last + 1])
        fall = float(np.linalg.norm(acceleration))  # whichever way: cameras are not always level
        smooth = missed < min(ROUGH_BY * height, ROUGH * float(np.ptp(path)) + 5e-4)
        seconds = float(clock[-1])
        arc = fall * seconds**2 / 8.0  # the same at every clock
        falls = -acceleration[2] > DOWNWARDS * fall and arc > ROUGH_BY * height and smooth
        if falls and not is_held_in(performance, slice(first, last + 1)):
            found.append((fall, seconds))
            spans.append(span)
    return np.array(found).reshape(-1, 2), tuple(spans)


def in_the_air(performance: Performance) -> BoolArray:
    """(T,) whether all points of the feet are up, and nothing else is near the floor."""
    points, floor = contact_points(performance)
    feet = [point.track[:, 2] for point in points.values() if point.kind.is_of_foot]
    clear = np.min(feet, axis=0) - floor > CLEAR * performance.character.height
    return np.asarray(clear & ~leans(performance, floor))


def _agreed(found: FloatArray, spans: Spans) -> Falls | None:
    """Of falls (N, 2), m/s² and s, and their frames, those that agree with their median; None where
    these are not nearly all, for then the recording does not tell which of them are falls."""
    accelerations, durations = found.T
    # Of the slope of velocities with independent errors the variance goes as T^-3.
    weights = durations**3
    order = np.argsort(accelerations, kind="stable")
    half = np.searchsorted(np.cumsum(weights[order]), 0.5 * weights.sum())
    apart = np.abs(np.log(accelerations / accelerations[order[half]]))
    alike = apart < AGREE * 2.0 * np.array([_uncertainty(each) for each in durations])
    if min(alike.mean(), weights[alike].sum() / weights.sum()) < MOST:
        return None
    mean = float(np.average(accelerations[alike], weights=weights[alike]))
    frames = tuple(span for span, each in zip(spans, alike, strict=True) if each)
    return Falls(mean, float(durations[alike].max()), frames)


def _acceleration(clock: FloatArray, path: FloatArray) -> FloatArray:
    """(3,) m/s², along a path (T, 3), m, at instants (T,), s: the slope of the velocities.

    How far the centre of mass is from where it seems wanders slowly, as limbs move whose masses are
    not known: its steps are independent, not its places, which a parabola would take for so.
    """
    middles = 0.5 * (clock[1:] + clock[:-1])
    velocities = np.diff(path, axis=0) / np.diff(clock)[:, None]
    return np.asarray(np.polyfit(middles, velocities, 1)[0])


def person_factor(height: float) -> float:
    """What makes a figure of so many m as tall as persons are; 1 where it is, and a unit's length
    where its numbers, in that unit, are a person's: children have not the usual height."""
    fitting = (unit for unit in WRITTEN if HEIGHTS[0] < unit * height < HEIGHTS[1])
    return next(fitting, USUAL_HEIGHT / height)


def find_scale(performance: Performance, trusted: Trusted = ALL) -> Finding | None:
    """A wrong scale of time or of size: whose it is the figure's height tells."""
    height, falls = performance.character.height, falls_of(performance, trusted)
    person = HEIGHTS[0] < height < HEIGHTS[1]
    if falls is None:
        if person:
            return None
        remedy = Repairs(scale=person_factor(height))
        return Finding(FindingKind.SIZE, height, "m", remedy=remedy)
    clock = float(np.sqrt(falls.acceleration / STANDARD_GRAVITY))  # durations times this are right
    if abs(np.log(clock)) < _honest(falls.longest * clock) and person:
        return None
    timed = Repairs(time_scale=_usual(clock, performance.recording.rate, falls.longest))
    sized = Repairs(scale=STANDARD_GRAVITY / falls.acceleration)
    if person:
        g = falls.acceleration
        return Finding(FindingKind.TIME_SCALE, g, "m/s²", falls.frames, "", timed, sized)
    if not HEIGHTS[0] < height * sized.scale < HEIGHTS[1]:
        sized = Repairs(scale=person_factor(height))  # the clock is wrong too
    return Finding(FindingKind.SIZE, height, "m", falls.frames, "", sized, timed)


def refined(size: Finding, resized: Performance, trusted: Trusted = ALL) -> Finding:
    """A finding of a wrong size with a factor that makes the fall right, by the falls of the
    recording as its remedy leaves it, or else with that of a wrong unit, where it is as near."""
    if size.remedy is None:
        return size
    scale, near = size.remedy.scale, OFF
    falls, height = falls_of(resized, trusted), resized.character.height
    if falls is not None:
        factor = STANDARD_GRAVITY / falls.acceleration
        if HEIGHTS[0] < height * factor < HEIGHTS[1]:
            scale *= factor
            near = 2.0 * _uncertainty(falls.longest)
    apart = np.abs(np.log(np.array(UNIT_RATIOS) / scale))
    first, second = np.argsort(apart, kind="stable")[:2]
    if apart[first] < near and apart[second] > CLEARLY * apart[first]:
        scale = UNIT_RATIOS[first]
    return replace(size, remedy=Repairs(scale=scale))


def find_leaps(performance: Performance) -> Finding | None:
    """Where the whole body is jerked downwards as nothing can: capture that lost it and finds it
    again leaves such jumps. performance: in its right size and time."""
    recording, height = performance.recording, performance.com[:, 2]
    reach = max(LEAP_FRAMES, round(LEAP_WINDOW * recording.rate))
    if len(height) <= 2 * reach:
        return None
    seconds = reach / recording.rate
    bent = height[2 * reach :] - 2.0 * height[reach:-reach] + height[: -2 * reach]
    fall = -bent / seconds**2 / STANDARD_GRAVITY
    places = runs(np.pad(fall > LEAP, reach))
    if not places:
        return None
    frames = tuple((float(recording.frames[a]), float(recording.frames[b])) for a, b in places)
    return Finding(FindingKind.LEAP, float(fall.max()), "g", frames)


def _usual(clock: float, rate: float, longest: float) -> float:
    """The scale of time with which the recording has a usual rate, where that is as near as the
    falls can tell."""
    true = rate / clock
    usual = min(usual_rates(rate), key=lambda each: abs(np.log(each / true)))
    near = _uncertainty(longest * clock)
    return rate / usual if abs(np.log(usual / true)) < near else clock


def _honest(longest: float) -> float:
    """Of the logarithm of a clock, by which honest recordings with a fall of so many seconds miss
    the right one: jumps up to 3 %, hops of 0.2 s up to 8 %."""
    return min(float(np.log1p(OFF)), SURE * _uncertainty(longest))


def _uncertainty(longest: float) -> float:
    """Relative, of a scale of time by a fall of so many seconds; of a size twice that."""
    return min(USUAL_NEAR * max(PRECISE_FALL / longest, 1.0), OFF)
