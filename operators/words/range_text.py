"""Sentences on a frame range that is not analysed as it was chosen."""

from __future__ import annotations

from .doubt_text import frame_doubts

_Span = tuple[float, float]


def range_words(asked: _Span | tuple[None, None], there: _Span, cycle: _Span) -> str:
    """Words that follow what was found: on frames that were chosen and are not there, and on a
    range that was moved to a whole cycle.

    asked: as the artist chose it, if so. there: what of it was recorded. cycle: what was analysed.
    """
    told = frame_doubts(asked, there)
    if cycle != there:
        first, last = cycle
        told.append(
            f"A whole cycle is frames {first:g} to {last:g}: the range begins "
            f"{first - there[0]:+g} and ends {last - there[1]:+g} frames from where it did"
        )
    return "".join(f". {line}" for line in told)
