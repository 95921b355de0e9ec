"""Support that is unseen for the figure lies, or legs are exchanged: no box was there, and no other
clock."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from ...data.faults import CarriedBy, OffBalance, UnseenSupport
from ...data.problem import Mend
from ...data.recording import Recording
from ..figure import figure_of
from ..frames.exchanges import find_exchange
from ..upright import find_up

Told = Sequence[CarriedBy]


def with_cause(told: Told, recording: Recording, chosen: Mapping[str, str]) -> Told:
    """What is told of a recording, where the figure lies or legs are exchanged with that as the
    cause. chosen: bones by parts of the body, as in a problem."""
    unseen = [(each.first, each.last) for each in told if isinstance(each, UnseenSupport)]
    unseen += [span for each in told if isinstance(each, OffBalance) for span in each.spans]
    if not unseen:
        return told
    figure = figure_of(recording, chosen)
    if find_up(recording, figure) is not None:
        first, last = min(first for first, _ in unseen), max(last for _, last in unseen)
        return (UnseenSupport(first, last, lying=True),)
    legs = find_exchange(recording, figure, Mend.LEGS)
    if legs is None:
        return told

    def explained(each: CarriedBy) -> CarriedBy:
        if isinstance(each, UnseenSupport) and legs.touches(each.first, each.last):
            alone = replace(each, boxes=(), rate=None, skidding=False, resting=False, holds=())
            return replace(alone, exchanged=True)
        return each

    return tuple(map(explained, told))
