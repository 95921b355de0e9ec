"""From which frame to which a constraint holds, and what the phases are."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ....bridge.properties.kinds import ConstraintKind, Instant, Span
from ....bridge.properties.phases import phases_of
from ....solver.data.traces import Traces
from ..geometry.shapes import Frames

if TYPE_CHECKING:
    from ....bridge.properties.constraint import HangtimeConstraint
    from ....bridge.properties.settings import HangtimeSettings

EVER: Frames = (-float("inf"), float("inf"))
NEVER: Frames = (float("inf"), -float("inf"))
NEAR = 0.5  # frames; what holds at one frame holds as long as that is shown


def named(settings: HangtimeSettings) -> dict[str, Frames]:
    """First and last frame of each phase, and of each frame that is held."""
    found = {phase.name: (phase.start, phase.end) for phase in phases_of(settings)}
    for row in settings.constraints:
        if row.kind == ConstraintKind.HOLD.name:
            found.setdefault(row.name, (row.first_frame, row.first_frame))
    return found


def span_of(
    row: HangtimeConstraint, known: dict[str, Frames], traces: Traces | None = None
) -> Frames:
    """From which frame to which a constraint holds; NEVER where its phase is not known.

    known: of `named`. traces: whose centre of mass tells the apex of a phase.
    """
    if row.span == Span.FRAMES.name:
        return row.first_frame, row.last_frame
    if row.span == Span.FRAME.name:
        return row.first_frame, row.first_frame
    if row.span == Span.ALWAYS.name:
        return EVER
    first, last = known.get(row.phase, NEVER)
    if row.instant == Instant.THROUGHOUT.name or first > last:
        return first, last
    at = {Instant.START.name: first, Instant.END.name: last}.get(row.instant)
    if at is None and row.instant == Instant.APEX.name and traces is not None:
        at = _apex(traces, first, last)
    at = 0.5 * (first + last) if at is None else at
    return at, at


def _apex(traces: Traces, first: float, last: float) -> float | None:
    during = (traces.frames >= first) & (traces.frames <= last)
    if not during.any():
        return None
    return float(traces.frames[during][traces.com[during, 2].argmax()])


def holds(span: Frames, frame: float) -> bool:
    """Whether a constraint holds at a frame."""
    return span[0] - NEAR <= frame <= span[1] + NEAR
