"""Free fall: whether a body falls while nothing touches, or something unseen carries it."""

from collections.abc import Iterable, Sequence

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..data.constants import STANDARD_GRAVITY
from ..data.contacts import Contact, ContactSchedule, Interval, gaps

MAX_FLIGHT = 1.2  # s; a rise of 1.8 m
MIN_FALL_WINDOW = 0.05  # s; over which an acceleration can be estimated
MIN_UNSEEN = 0.1  # s, of a fall beside unseen support, and of what that leaves at a gap's ends
FREE_FALL_TOLERANCE = 6.0  # m/s²; short flights, and the ends of clips, are that uncertain
FALL_RESIDUAL = 0.03  # m, rms; a centre of mass further from every parabola is carried
# m/s² and m, rms: by which recorded flights of 0.1 s and more are off gravity and a parabola; a
# dance whose floor drifts has falls that are 2.2 and 0.006 off, and are none
CLEAR_FALL, CLEAR_RESIDUAL = 2.0, 0.003
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
            cut.append((start - gap.start, end - gap.start))
    left = gaps(cut, gap.end - gap.start)
    return tuple(Interval(gap.start + piece.start, gap.start + piece.end) for piece in left)


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
