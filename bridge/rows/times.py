"""When a constraint of the artist's list holds: as the solver's When, and in scene frames."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf
from typing import Any

import numpy as np

from ...solver.analysis.timeline import moment_within
from ...solver.data.faults import EmptyRange, NoPhaseChosen, UnknownPhaseIn
from ...solver.data.requests import ALWAYS, Moment, When
from ...solver.data.traces import Traces
from .choices import HOLD, Instant, Span
from .phases import clip_ends, names, phases_of, recorded_span
from .protocols import Settings

Frames = tuple[float, float]  # the first and the last
Spans = Mapping[str, Frames]  # of phases, by name
EVER: Frames = (-inf, inf)
NEVER: Frames = (inf, -inf)
MOMENTS = {
    Instant.START: Moment.START,
    Instant.MIDDLE: Moment.MIDDLE,
    Instant.APEX: Moment.APEX,
    Instant.END: Moment.END,
}


@dataclass(frozen=True)
class Clip:
    """The recording's time. ends: first and last scene frame. known: names that a constraint may
    give for a phase; phases: the frames of those among them that lie in the recording."""

    ends: Frames
    known: tuple[str, ...]
    phases: Spans

    @staticmethod
    def of(settings: Settings, ends: Frames | None = None) -> Clip:
        """The analysed clip; ends are looked up where not given."""
        ends = ends or clip_ends(settings) or recorded_span(settings) or (1.0, 1.0)
        phases = {phase.name: (phase.start, phase.end) for phase in phases_of(settings)}
        return Clip(ends, names(settings), phases)


def named_frames(settings: Settings) -> Spans:
    """The frames of each phase, and of each frame that is held."""
    found = {phase.name: (phase.start, phase.end) for phase in phases_of(settings)}
    for row in settings.constraints:
        if row.kind == HOLD:
            found.setdefault(row.name, (row.first_frame, row.first_frame))
    return found


def when_of(row: Any, clip: Clip) -> When:
    """Raises NoPhaseChosen, UnknownPhaseIn, EmptyRange."""
    match Span[row.span]:
        case Span.PHASE:
            return When(phase_of(row, clip), moment=MOMENTS.get(Instant[row.instant]))
        case Span.FRAMES:
            if row.first_frame > row.last_frame:
                raise EmptyRange(row.name, row.first_frame, row.last_frame)
            return When(frames=(row.first_frame, row.last_frame))
        case Span.FRAME:
            return When(frames=(row.first_frame, row.first_frame))
    return ALWAYS


def phase_of(row: Any, clip: Clip) -> str:
    """The phase that a row names. Raises NoPhaseChosen, UnknownPhaseIn."""
    if not row.phase:
        raise NoPhaseChosen(row.name, clip.known)
    if row.phase not in clip.known:
        raise UnknownPhaseIn(row.name, row.phase, clip.known)
    return str(row.phase)


def interval_of(row: Any, phases: Spans, motion: Traces | None) -> Frames:
    """First and last scene frame at which a row holds, the same for an instant; EVER for always,
    NEVER where its phase is not known.

    phases: only looked at for a row that names one. motion: whose centre of mass is highest at an
    apex, as the solver finds it; without one, an apex is drawn in its phase's middle.
    """
    first, last = throughout(row, phases)
    moment = MOMENTS.get(Instant[row.instant]) if row.span == Span.PHASE.name else None
    if moment is None or first > last:
        return first, last
    if moment is Moment.APEX and motion is None:
        moment = Moment.MIDDLE
    heights = np.zeros((0, 2))
    if motion is not None:
        heights = np.stack([motion.frames, motion.com[:, 2]], axis=1)
    at = moment_within(moment, first, last, heights)
    return NEVER if at is None else (at, at)


def throughout(row: Any, phases: Spans) -> Frames:
    """First and last scene frame of what a row names, of an instant the whole phase; else as of
    `interval_of`."""
    match Span[row.span]:
        case Span.PHASE:
            return phases.get(row.phase, NEVER)
        case Span.FRAMES:
            return row.first_frame, row.last_frame
        case Span.FRAME:
            return row.first_frame, row.first_frame
    return EVER
