"""Phases of a clip for those who draw them: ground and flight in turn, in scene frames."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from ...solver.data.contacts import PhaseKind, gaps
from ...solver.data.reports.report import Report
from ..hidden_texts import spans_text
from .choices import HOLD
from .protocols import ContactRow, Settings

SAME = 1e-3  # frames; single precision keeps frames
TAKE_OFF, STANCE = "Take-Off", "Stance"
UNSEEN = spans_text("unseen")


@dataclass(frozen=True)
class PhaseSpan:
    """From when to when a phase lasts, scene frames; number counts from 1 in each kind."""

    kind: PhaseKind
    number: int
    start: float
    end: float

    @property
    def name(self) -> str:
        """Such as "flight 1", as the analysis calls it."""
        return f"{self.kind.value} {self.number}"

    @property
    def is_ground(self) -> bool:
        return self.kind is PhaseKind.GROUND


def phases(
    carried: Iterable[tuple[float, float]], first: float, last: float
) -> tuple[PhaseSpan, ...]:
    """Phases of the clip [first, last] that is carried during some intervals."""
    inside = [(max(a, first) - first, min(b, last) - first) for a, b in carried]
    flights = [g for g in gaps(inside, last - first) if g.end - g.start > SAME]
    ground = gaps(((g.start, g.end) for g in flights), last - first)
    kinds = ((PhaseKind.FLIGHT, flights), (PhaseKind.GROUND, ground))
    spans = [
        PhaseSpan(kind, number, first + gap.start, first + gap.end)
        for kind, several in kinds
        for number, gap in enumerate(several, start=1)
    ]
    return tuple(sorted(spans, key=lambda span: span.start))


def listed(settings: Settings) -> list[ContactRow]:
    """The contacts that are there, of which some may be switched off."""
    return [row for row in settings.contacts if not row.surplus]


def carried(settings: Settings) -> list[tuple[float, float]]:
    """When contacts that count touch, as the artist has them, or something unseen carries."""
    touching = [(row.start_frame, row.end_frame) for row in settings.contacts if row.used]
    return [*touching, *unseen_frames(settings)]


def unseen_frames(settings: Settings) -> list[tuple[float, float]]:
    """First and last scene frame of each interval in which something unseen carries the body; they
    overlap the contacts beside them, whose frames have single precision, by a hair."""
    return [(first - SAME, last + SAME) for first, last in UNSEEN.of(settings.unseen)]


def clip_ends(settings: Settings) -> tuple[float, float] | None:
    """First and last frame of the analysed clip; None before an analysis."""
    contacts = listed(settings)
    if not contacts:
        return None
    first = min(row.found_start for row in contacts)
    last = max(row.found_end for row in contacts)
    if settings.use_range:
        return min(first, settings.first_frame), max(last, settings.last_frame)
    action = recorded_span(settings)
    return (first, last) if action is None else (min(first, action[0]), max(last, action[1]))


def recorded_span(settings: Settings) -> tuple[float, float] | None:
    """First and last frame of the recording's action, where there is one."""
    from ..accessors import (
        current_action,
        played_source,
        shown_range,
    )  # late: kinds load without Blender

    action = current_action(settings.id_data)
    if action is None:
        return None
    return shown_range(settings.id_data, played_source(settings.id_data, action))


def phases_of(settings: Settings) -> tuple[PhaseSpan, ...]:
    """The phases of the analysed clip as the artist's contacts have them; none before."""
    ends = clip_ends(settings)
    return phases(carried(settings), *ends) if ends is not None else ()


def roles(settings: Settings) -> dict[str, str]:
    """What each stance is to the clip, by its phase's name: "Take-Off", "Landing 2", "Stance"."""
    every = phases_of(settings)
    flights = sum(not phase.is_ground for phase in every)
    found, flown = {}, 0
    for index, phase in enumerate(every):
        if not phase.is_ground:
            flown += 1
        elif flown:
            found[phase.name] = f"Landing {flown}" if flights > 1 else "Landing"
        else:
            found[phase.name] = TAKE_OFF if index + 1 < len(every) else STANCE
    return found


def roles_in(settings: Settings, report: Report) -> dict[str, str]:
    """As `roles`, of a result's stances. Where the fit doubts a flight, the stances beside it are
    one by the first one's name, which then is neither."""
    every, found = phases_of(settings), roles(settings)
    kept = {phase.phase for phase in report.phases}
    first, last = report.times.recorded_frame[0], report.times.recorded_frame[-1]
    for index, phase in enumerate(every):
        inside = first - SAME <= phase.start and phase.end <= last + SAME
        if not phase.is_ground and inside and phase.name not in kept:
            beside = every[max(index - 1, 0) : index + 2]
            found |= {each.name: STANCE for each in beside if each.is_ground}
    return found


def names(settings: Settings) -> tuple[str, ...]:
    """What a constraint may be about: the phases and the frames that are held, in time."""
    holds = (row.name for row in settings.constraints if row.kind == HOLD)
    return (*(phase.name for phase in phases_of(settings)), *holds)
