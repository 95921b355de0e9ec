"""A fit that ends: what a recording contradicts itself in is let go, step by step, and told.

Contacts that cannot be held together, and phases that what touches does not explain, are found
from the rows that the fit could not meet. A contact that is let go leaves its point to the
recording; what it carried something unseen carries (unseen/support_force.py). With no contact left
and such a force throughout, any motion can be had: so the fit ends.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from ..analysis.balance import off_balance
from ..analysis.performance import Performance, leans, snap_tolerance
from ..data.contacts import ContactSchedule, Interval, Phase, PhaseKind, gaps
from ..data.row_kinds import RowKind
from ..numerics.runs import runs
from ..optimisation.sqp import Progress
from ..transcription.ride import Ride
from ..transcription.rows import Rows
from ..unseen.free_fall import clear_falls
from .fit import Fit, LetGo, fit

MAX_ROUNDS = 6  # then everything is let go
WORST_SHARE = 0.5  # of the worst contact's miss: who misses more is let go with it
FAR = 0.03  # m, rms over joint centres; further off it is doubted what carried it
OFF_PARABOLA = 0.03  # m, by which the recorded centre of mass leaves the fit's parabola
MUCH_NEARER = 0.8  # times as far: what something unseen must gain
AGAINST_A_FALL = 0.5  # likewise, where the recorded centre of mass clearly falls in a flight
CONTRADICTORY = 1e-3  # m; contacts that miss by less follow what else does not hold

Rides = Callable[[ContactSchedule], Sequence[Ride | None]]


def lasting_fit(
    performance: Performance,
    schedule: ContactSchedule,
    rides: Rides,
    *,
    good_enough: float = 0.0,
    periodic: bool = False,
    progress: Progress | None = None,
) -> Fit:
    """The valid motion nearest to the recording, with as many of its contacts as go together.

    rides: of a schedule's contacts. good_enough: m by which contacts that cannot be held exactly
    may miss their places before any is let go. Of a motion that repeats nothing is let go: as `fit`
    has it. Phases keep their names, those that are joined the first one's.
    """
    let_go: list[LetGo] = []
    asked = schedule
    flights = [phase for phase in asked.phases if phase.kind is PhaseKind.FLIGHT]
    for remaining in reversed(range(MAX_ROUNDS + 1)):
        found = fit(
            performance, schedule, periodic=periodic, rides=rides(schedule), progress=progress
        )
        if found.solved or periodic or remaining == 0:
            break
        accepted = _accepted(found, schedule, good_enough)
        if accepted is not schedule:
            schedule = accepted
            continue
        released = _contradictory(found) if remaining > 1 else _every(schedule)
        easier = _without(schedule, released) if released else _carried(found)
        if remaining == 1:
            easier = replace(easier, unseen=(Interval(0.0, schedule.duration),))
        if not released and easier.unseen == schedule.unseen:
            break  # nothing is left to let go of
        schedule = easier
        let_go += released
    if found.solved and not periodic:
        for doubted in (_beside_feet, _not_flown_or_leaning):
            found = _nearer(found, doubted(found), rides, progress)
    named = found.schedule.named_as(asked)
    carried = tuple(f for f in flights if any(_is_mostly_in(f, u) for u in named.unseen))
    return replace(found, schedule=named, let_go=tuple(let_go), carried=carried)


def _is_mostly_in(flight: Phase, unseen: Interval) -> bool:
    both = min(flight.end, unseen.end) - max(flight.start, unseen.start)
    return both > 0.5 * (flight.end - flight.start)


def _nearer(
    found: Fit, doubted: Sequence[Interval], rides: Rides, progress: Progress | None
) -> Fit:
    """The fit with more unseen support, where that is other than before and brings it much nearer;
    else as it is."""
    told = _unseen_too(found.schedule, doubted)
    if told.unseen == found.schedule.unseen:
        return found
    again = fit(found.performance, told, rides=rides(told), progress=progress)
    performance, flights = found.performance, found.schedule.flights
    falls = clear_falls(performance.times, performance.com, flights)
    least = AGAINST_A_FALL if any(fall in doubted for fall in falls) else MUCH_NEARER
    return again if again.solved and _off(again) < least * _off(found) else found


def _off(found: Fit, start: float = 0.0, end: float = np.inf) -> float:
    """Distance of a fit from its recording, m, rms over joint centres, from one instant, s, to
    another."""
    times = found.performance.times
    within = (times >= start) & (times <= end)
    apart = found.motion.joint_centres(times[within]) - found.performance.centres[within]
    return float(np.sqrt((apart**2).sum(axis=2).mean()))


def _beside_feet(found: Fit) -> tuple[Interval, ...]:
    """Where a fit is far from its recording, and the weight was recorded beside what touches."""
    performance, schedule = found.performance, found.schedule
    beside = off_balance(performance, schedule)
    far = [each for each in beside if _off(found, each.start, each.end) > FAR]
    return _joined(performance, schedule, far)


def _not_flown_or_leaning(found: Fit) -> tuple[Interval, ...]:
    """Of a fit far from its recording, where a flight may never have been, or more than feet may
    have carried."""
    if _off(found) < FAR:
        return ()
    return (*_never_flown(found), *leaning(found.performance, found.schedule))


def _never_flown(found: Fit) -> tuple[Interval, ...]:
    """The flights of a fit in which the centre of mass was recorded away from any parabola near by:
    those that never were."""
    performance = found.performance
    away = np.linalg.norm(found.motion.com(performance.times) - performance.com, axis=1)
    times, flights = performance.times, found.schedule.flights
    return tuple(
        f
        for f in flights
        if away[(times >= f.start) & (times <= f.end)].max(initial=0.0) > OFF_PARABOLA
    )


def leaning(performance: Performance, schedule: ContactSchedule) -> tuple[Interval, ...]:
    """Where hands, knees or the trunk are on the floor: what they carry no contact tells."""
    times, low = performance.times, runs(leans(performance, schedule.floor_m))
    spans = [Interval(float(times[a]), float(times[b])) for a, b in low if b > a]
    return _joined(performance, schedule, spans)


def _joined(
    performance: Performance, schedule: ContactSchedule, spans: Sequence[Interval]
) -> tuple[Interval, ...]:
    """Intervals that begin and end where contacts or others do, if these are near: moments in
    between, such as of a flight, would spoil the equations."""
    near, edges = snap_tolerance(performance), np.array(schedule.boundaries)
    made = []
    for span in spans:
        before, after = edges[edges <= span.start], edges[edges >= span.end]
        first = before.max() if span.start - before.max() < near else span.start
        last = after.min() if after.min() - span.end < near else span.end
        made.append(Interval(float(first), float(last)))
    return tuple(made)


def _accepted(failed: Fit, schedule: ContactSchedule, good_enough: float) -> ContactSchedule:
    """The schedule with slack for the contacts that a failed fit misses, where all are missed by
    no more than what is good enough; else as it is."""
    missed = _missed(failed)
    if max(missed, default=0.0) > good_enough:
        return schedule
    contacts = tuple(
        replace(contact, slack=good_enough) if off > RowKind.PIN.tolerance else contact
        for contact, off in zip(schedule.contacts, missed, strict=True)
    )
    same = all(a.slack == b.slack for a, b in zip(contacts, schedule.contacts, strict=True))
    return schedule if same else replace(schedule, contacts=contacts)


def _missed(fitted: Fit) -> list[float]:
    """By how much, m, each contact's point misses its place at its worst."""
    rows = _rows(fitted)
    off, pinned = np.abs(rows.violation()), rows.kind == RowKind.PIN
    return [
        float(off[pinned & (rows.owner == i)].max(initial=0.0))
        for i in range(len(fitted.schedule.contacts))
    ]


def _every(schedule: ContactSchedule) -> list[LetGo]:
    return [LetGo(contact, 0.0) for contact in schedule.contacts]


def _contradictory(failed: Fit) -> list[LetGo]:
    """The contacts that a failed fit misses the furthest; none where others are to blame."""
    rows = _rows(failed)
    worst = list(zip(_missed(failed), failed.schedule.contacts, strict=True))
    most = max((off for off, _ in worst), default=0.0)
    if most < CONTRADICTORY and _violated_phases(failed, rows):
        return []
    if most <= RowKind.PIN.tolerance:
        return _every(failed.schedule)
    return [LetGo(contact, off) for off, contact in worst if off >= WORST_SHARE * most]


def _rows(failed: Fit) -> Rows:
    outcome = failed.outcome
    return outcome.transcription.rows(outcome.x, outcome.places)


def _violated_phases(failed: Fit, rows: Rows) -> list[Interval]:
    """The phases whose equations do not hold, but those that something unseen carries through."""
    over = (rows.owner < 0) & (np.abs(rows.violation()) > rows.tolerance)
    times = rows.time[over]
    return [
        Interval(phase.start, phase.end)
        for phase in failed.schedule.phases
        if ((times >= phase.start) & (times <= phase.end)).any()
        and not any(u.start <= phase.start and u.end >= phase.end for u in failed.schedule.unseen)
    ]


def _carried(failed: Fit) -> ContactSchedule:
    """The schedule with unseen support in the phases whose equations do not hold."""
    return _unseen_too(failed.schedule, _violated_phases(failed, _rows(failed)))


def _unseen_too(schedule: ContactSchedule, added: Sequence[Interval]) -> ContactSchedule:
    """The schedule with unseen support in more intervals."""
    free = gaps([(u.start, u.end) for u in (*schedule.unseen, *added)], schedule.duration)
    unseen = gaps([(f.start, f.end) for f in free], schedule.duration)
    return replace(schedule, unseen=unseen)


def _without(schedule: ContactSchedule, released: Sequence[LetGo]) -> ContactSchedule:
    """The schedule without these contacts; what nothing else carries then something unseen does."""
    names = {each.contact.name for each in released}
    kept = tuple(c for c in schedule.contacts if c.name not in names)
    spans = [(c.start, c.end) for c in kept] + [(f.start, f.end) for f in schedule.flights]
    return _unseen_too(replace(schedule, contacts=kept), gaps(spans, schedule.duration))
