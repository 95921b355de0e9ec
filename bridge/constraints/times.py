"""When a constraint of the artist's list holds: as the solver's When, and in scene frames."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ...solver.data.faults import EmptyRange, NoPhaseChosen, UnknownPhaseIn
from ...solver.data.requests import ALWAYS, Moment, When
from ..properties.kinds import Instant, Span
from ..properties.phases import PhaseSpan, clip_ends, names, phases_of, recorded_span

if TYPE_CHECKING:
    from ..properties.constraint import HangtimeConstraint
    from ..properties.settings import HangtimeSettings

MOMENTS = {
    Instant.THROUGHOUT: None,
    Instant.START: Moment.START,
    Instant.MIDDLE: Moment.MIDDLE,
    Instant.APEX: Moment.APEX,
    Instant.END: Moment.END,
}


@dataclass(frozen=True)
class Clip:
    """The recording's time. ends: first and last scene frame. known: names that a constraint may
    give for a phase; phases: those among them that lie in the recording."""

    ends: tuple[float, float]
    known: tuple[str, ...]
    phases: tuple[PhaseSpan, ...]

    @staticmethod
    def of(settings: HangtimeSettings, ends: tuple[float, float] | None = None) -> Clip:
        """The analysed clip; ends are looked up where not given."""
        ends = ends or clip_ends(settings) or recorded_span(settings) or (1.0, 1.0)
        return Clip(ends, names(settings), phases_of(settings))


def when_of(row: HangtimeConstraint, clip: Clip) -> When:
    """Raises NoPhaseChosen, UnknownPhaseIn, EmptyRange."""
    match Span[row.span]:
        case Span.PHASE:
            return When(phase_of(row, clip), moment=MOMENTS[Instant[row.instant]])
        case Span.FRAMES:
            if row.first_frame > row.last_frame:
                raise EmptyRange(row.name, row.first_frame, row.last_frame)
            return When(frames=(row.first_frame, row.last_frame))
        case Span.FRAME:
            return When(frames=(row.first_frame, row.first_frame))
    return ALWAYS


def phase_of(row: HangtimeConstraint, clip: Clip) -> str:
    """The phase that a row names. Raises NoPhaseChosen, UnknownPhaseIn."""
    if not row.phase:
        raise NoPhaseChosen(row.name, clip.known)
    if row.phase not in clip.known:
        raise UnknownPhaseIn(row.name, row.phase, clip.known)
    return str(row.phase)


def frames_of(row: HangtimeConstraint, clip: Clip) -> tuple[float, float]:
    """First and last scene frame within the clip during which a row holds; of a hold or an instant
    the whole clip, as it is known to the solver alone. Raises as `when_of`."""
    when = when_of(row, clip)
    first, last = when.frames or clip.ends
    for phase in clip.phases:
        if phase.name == when.phase:
            first, last = phase.start, phase.end
    return max(first, clip.ends[0]), min(last, clip.ends[1])
