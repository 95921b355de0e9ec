"""The part of a long take that an edit is about, which alone is fitted and adapted.

A landing that moves changes the push before it and the stance after it; what a fit and an
adaptation of all the other jumps would cost buys nothing. Where pins alone are asked for, the
frames from the push before the first pinned stance to where the last one has come to rest are
solved as if they had been chosen as the range: the take before them stays, and what follows is
carried along with the last stance, as it is after any range (bridge/takes/whole_take.py). A take
that is mended, or whose contacts the artist has corrected, is solved whole: what stays would be
what the recording was before.
"""

from collections.abc import Sequence

from ..analysis.analyse import Analysis, part_of
from ..analysis.pins.pinned_places import phase_of
from ..data.contacts import ContactSchedule, Phase, PhaseKind
from ..data.problem import MotionProblem, Pin

PUSH = 0.8  # s before a take-off, which a crouch and the swing of the arms take
REST = 1.2  # s after a landing, by which a jumper stands again
MIN_REST = 0.6  # s; with less, what follows cannot be carried by a stance
CUT_APART = 0.06  # s, of a cut from where a contact begins or ends
CUT_STEP = 0.01  # s
MIN_SAVED = 2.0  # s of a range, for which it is not cut


def edited_part(analysis: Analysis, problem: MotionProblem) -> Analysis:
    """The part of an analysis that a problem's pins are about; all of it where that is most of it,
    or where more is asked for than pins of stances that last. Raises UnknownPhase."""
    schedule = analysis.schedule
    span = _span(schedule, problem)
    if span is None or schedule.duration - (span[1] - span[0]) < MIN_SAVED:
        return analysis
    return part_of(analysis, *span)


def _span(schedule: ContactSchedule, problem: MotionProblem) -> tuple[float, float] | None:
    if not problem.pins_alone:
        return None
    stances = [phase for phase in schedule.phases if phase.kind is PhaseKind.GROUND]
    pinned = [stances.index(phase_of(pin, schedule)) for pin in problem.pins]
    start = _begin(stances[: min(pinned)], schedule)
    last = max(*pinned, 1)  # a first stance that is moved changes the jump after it
    if last == len(stances):
        return None
    end = _end(stances[last], schedule, _pinned_until(stances[last], problem.pins, schedule))
    return None if end is None else (start, end)


def _pinned_until(stance: Phase, pins: Sequence[Pin], schedule: ContactSchedule) -> float:
    """The instant by which all contacts that pins move have begun, as the steps of a walk do.

    A stance that is pushed or raised as one needs none of the later ones: all move alike.
    """
    if all(
        not pin.touching and pin.step is None and pin.place is None and pin.turn == 0.0
        for pin in pins
        if pin.phase == stance.name
    ):
        return stance.start
    return max(contact.start for contact in schedule.of_phase(stance))


def _begin(before: Sequence[Phase], schedule: ContactSchedule) -> float:
    """An instant in the last stance that is long enough for a push; else the range's first."""
    for stance in reversed(before):
        found = _cut(schedule, stance.end - PUSH, -CUT_STEP, stance)
        if found is not None:
            return found
    return 0.0


def _end(stance: Phase, schedule: ContactSchedule, pinned: float) -> float | None:
    """An instant in a stance at which the body has come to rest; None where it lasts too short.

    pinned: s, as of `_pinned_until`.
    """
    ends = stance.end >= schedule.duration
    if ends and stance.end - stance.start <= REST:
        return schedule.duration
    found = _cut(schedule, max(stance.start + REST, pinned + CUT_APART), CUT_STEP, stance)
    if found is None:
        found = _cut(schedule, stance.end - CUT_APART, -CUT_STEP, stance)
    if found is not None and found - stance.start >= MIN_REST and found > pinned:
        return found
    return schedule.duration if ends else None


def _cut(schedule: ContactSchedule, at: float, step: float, stance: Phase) -> float | None:
    """The first instant from `at` on, in steps, at which the stance can be cut; None without."""
    while stance.start + CUT_APART <= at <= stance.end - CUT_APART:
        if min(abs(at - edge) for edge in schedule.boundaries) >= CUT_APART:
            return at
        at += step
    return None
