"""Free fall: whether a body falls while nothing touches, or something unseen carries it."""

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from ..arrays import BoolArray, FloatArray
from ..data.constants import STANDARD_GRAVITY, UP
from ..data.contacts import Contact, ContactSchedule, Interval, gaps
from ..numerics.runs import runs

MAX_FLIGHT = 1.2  # s; a rise of 1.8 m
MIN_FALL_WINDOW = 0.05  # s; over which an acceleration can be estimated
MIN_UNSEEN = 0.1  # s, of a fall beside unseen support, and of what that leaves at a gap's ends
FREE_FALL_TOLERANCE = 6.0  # m/s²; short flights, and the ends of clips, are that uncertain
FALL_RESIDUAL = 0.03  # m, rms; a centre of mass further from every parabola is carried
# m/s² and m, rms: by which recorded flights of 0.1 s and more are off gravity and a parabola; a
# dance whose floor drifts has falls that are 2.2 and 0.006 off, and are none
CLEAR_FALL, CLEAR_RESIDUAL = 2.0, 0.003
# s, at least, of a fall that only the centre of mass tells: who bobs twice a second, and is without
# weight at each crest, nearly falls for 0.23 s there; a flight of 0.25 s rises by 8 cm.
SURE_FALL = 0.25
FALL_WINDOW = 0.1  # s, over which an acceleration is told within it, and
ROUGH_FALL = 4.0  # m/s², by which that may be off: by up to 4 flights' are, as limbs swing
COM_NOISE = 0.001  # m, from frame to frame, of a recorded centre of mass
STANDARD_ERRORS = 3.0  # of a fitted acceleration, before it speaks against a free fall


def unseen_support(
    contacts: Iterable[Contact],
    duration: float,
    times: FloatArray,
    com: FloatArray | None,
    known: Iterable[Interval] = (),
    falls: Sequence[Interval] = (),
) -> tuple[Interval, ...]:
    """Intervals of [0, duration], s, without a contact in which the body does not fall, or within
    those that are known to be such; but for falls that are known in them."""
    carried, told = ((c.start, c.end) for c in contacts), tuple(known)
    return tuple(
        piece
        for gap in gaps(carried, duration)
        if any(each.start <= gap.start and gap.end <= each.end for each in told)
        or not _may_be_free_fall(times, com, gap)
        for piece in without_falls(gap, falls)
    )


def without_falls(gap: Interval, falls: Sequence[Interval]) -> tuple[Interval, ...]:
    """What falls leave of a gap between contacts, s. One that ends about where the gap does ends
    with it: contacts are corrected after it was found. Shorter ones than a rest tell nothing."""
    cut = []
    for fall in falls:
        start = gap.start if fall.start - gap.start < MIN_UNSEEN else fall.start
        end = gap.end if gap.end - fall.end < MIN_UNSEEN else fall.end
        if min(end, gap.end) - max(start, gap.start) >= MIN_UNSEEN:
            cut.append((start, end))
    return gaps([(0.0, gap.start), *cut], gap.end)


def falls_within(
    times: FloatArray, com: FloatArray, intervals: Iterable[Interval]
) -> tuple[Interval, ...]:
    """The parts of intervals, s, in which the body clearly falls all along, however it is carried
    in the rest: who lets go of a bar. Apart from each other by what unseen support lasts.

    times: (T,) s, evenly apart. com: (T, 3) m, world; neither up nor along the ground may anything
    but gravity accelerate it.
    """
    half = max(2, round(0.5 * FALL_WINDOW * (len(times) - 1) / float(times[-1] - times[0])))
    rough = _off_all_along(times, com, half) < ROUGH_FALL
    found: list[Interval] = []
    for whole in intervals:
        inside = (times >= whole.start) & (times <= whole.end)
        parts = (
            Interval(float(times[max(a - half, 0)]), float(times[min(b + half, len(times) - 1)]))
            for a, b in runs(rough & inside)
        )
        within = [Interval(max(p.start, whole.start), min(p.end, whole.end)) for p in parts]
        lasting = [each for each in within if each.end - each.start >= SURE_FALL]
        for fall in sorted(clear_falls(times, com, lasting), key=lambda f: f.start - f.end):
            if all(_apart(fall, other) >= MIN_UNSEEN for other in found):
                found.append(fall)
    return tuple(sorted(found, key=lambda fall: fall.start))


def _off_all_along(times: FloatArray, com: FloatArray, half: int) -> FloatArray:
    """(T,) m/s², how far the acceleration is off gravity, by parabolas through `half` frames on
    either side; infinite nearer to the ends."""
    off, count = np.full(len(times), np.inf), 2 * half + 1
    if len(times) < count:
        return off
    step = float(times[-1] - times[0]) / (len(times) - 1)
    curvature = np.polyfit(step * np.arange(count), np.eye(count), 2)[0]
    accelerations = 2.0 * sliding_window_view(com, count, axis=0) @ curvature
    off[half:-half] = np.linalg.norm(accelerations + STANDARD_GRAVITY * UP, axis=1)
    return off


def _apart(one: Interval, other: Interval) -> float:
    """S between two intervals; below 0 where they overlap."""
    return max(one.start, other.start) - min(one.end, other.end)


def falls_beside_unseen(schedule: ContactSchedule) -> tuple[Interval, ...]:
    """The flights that begin or end where something unseen carries the body."""
    ends = {t for each in schedule.unseen for t in (each.start, each.end)}
    return tuple(f for f in schedule.flights if f.start in ends or f.end in ends)


def clear_falls(
    times: FloatArray, com: FloatArray, flights: Iterable[Interval]
) -> tuple[Interval, ...]:
    """Those of flights that nothing but gravity explains, whatever is said to carry there."""
    found = []
    for flight in flights:
        off = off_gravity(times, com, flight, CLEAR_RESIDUAL)
        if off is not None and off < CLEAR_FALL:
            found.append(flight)
    return tuple(found)


def is_free_fall(times: FloatArray, com: FloatArray | None, gap: Interval) -> bool:
    """Whether the body is in free fall during `gap`, so far as that can be told."""
    off = off_gravity(times, com, gap)
    return off is None or off < FREE_FALL_TOLERANCE


def _may_be_free_fall(times: FloatArray, com: FloatArray | None, gap: Interval) -> bool:
    """Whether the recording allows a free fall during `gap`: a few frames tell little."""
    if com is None:
        return gap.end - gap.start < MAX_FLIGHT
    off = off_gravity(times, com, gap)
    return off is None or off < max(FREE_FALL_TOLERANCE, STANDARD_ERRORS * _uncertainty(times, gap))


def off_gravity(
    times: FloatArray, com: FloatArray | None, gap: Interval, rough: float = FALL_RESIDUAL
) -> float | None:
    """By how much the centre of mass's acceleration differs from gravity, m/s², by the parabola
    that fits best; infinite where none fits, None where it cannot be told. rough: m, rms, by which
    it may miss it."""
    t, within = _around(times, gap)
    if com is None or len(t) < 4:
        return None
    fitted = np.polyfit(t, com[within, 2], 2)
    if np.std(com[within, 2] - np.polyval(fitted, t)) > rough:
        return np.inf
    return float(abs(2.0 * fitted[0] + STANDARD_GRAVITY))


def _uncertainty(times: FloatArray, gap: Interval) -> float:
    """Standard error, m/s², of an acceleration told by the frames around a gap (least squares)."""
    t, _ = _around(times, gap)
    without_line = t**2 - np.polyval(np.polyfit(t, t**2, 1), t)
    return float(2.0 * COM_NOISE / np.linalg.norm(without_line))


def _around(times: FloatArray, gap: Interval) -> tuple[FloatArray, BoolArray]:
    """Times s from the middle of a gap, and which frames they are: enough for an acceleration."""
    middle, half = (gap.start + gap.end) / 2, max(gap.end - gap.start, MIN_FALL_WINDOW) / 2
    within = np.asarray(np.abs(times - middle) <= half)
    return times[within] - middle, within
