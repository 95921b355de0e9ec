"""Parts of a clip that were retimed, as by a speed ramp: flights in which the body falls otherwise
than in the others."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..analysis.performance import Performance
from ..data.constants import STANDARD_GRAVITY
from .falls import ALL, OFF, Trusted, each_fall
from .finding import Finding, FindingKind

RETIMED = np.log(1.25)  # of a clock; honest flights that last so long are up to 7 % off
LONG = 0.2  # s, at the clock that a flight tells; of shorter ones the fall is vague


def find_retimed(performance: Performance, trusted: Trusted = ALL) -> Finding | None:
    """Flights whose clock is wrong, where that of others is right. performance: in its right size
    and time."""
    found, spans = each_fall(performance, trusted)
    clocks = np.sqrt(found[:, 0] / STANDARD_GRAVITY)
    off = np.where(clocks * found[:, 1] > LONG, np.log(clocks), 0.0)
    right = (np.abs(np.log(clocks)) < np.log1p(OFF)) & (found[:, 1] > LONG)
    retimed = np.abs(off) > RETIMED
    if not retimed.any() or not right.any():
        return None
    frames = tuple(span for span, each in zip(spans, retimed, strict=True) if each)
    worst = int(np.argmax(np.abs(off)))
    return Finding(FindingKind.RETIMED, float(found[worst, 0]), "m/s²", frames)


def explained(notes: Sequence[Finding], retimed: Finding) -> list[Finding]:
    """Without what seems to carry the body unseen in flights that were retimed."""
    found = list[Finding]()
    for note in notes:
        if note.kind is FindingKind.UNSEEN_SUPPORT:
            left = tuple(span for span in note.frames if not retimed.touches(*span))
            note = replace(note, frames=left)
        if note.frames or note.kind is not FindingKind.UNSEEN_SUPPORT:
            found.append(note)
    return found
