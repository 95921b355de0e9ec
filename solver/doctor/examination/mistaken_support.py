"""Support that is unseen for legs are exchanged: no box was there, and no other clock."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from ...data.faults import Treadmill, UnseenSupport
from ...data.problem import Mend
from ...data.recording import Recording
from ..figure import figure_of
from ..frames.exchanges import find_exchange

Told = Sequence[UnseenSupport | Treadmill]


def with_cause(told: Told, recording: Recording, chosen: Mapping[str, str]) -> Told:
    """What is told of a recording, where legs are exchanged with that as the cause. chosen: bones
    by parts of the body, as in a problem."""
    legs = find_exchange(recording, figure_of(recording, chosen), Mend.LEGS) if told else None
    if legs is None:
        return told

    def explained(each: UnseenSupport | Treadmill) -> UnseenSupport | Treadmill:
        if isinstance(each, UnseenSupport) and legs.touches(each.first, each.last):
            return replace(each, boxes=(), rate=None, exchanged=True, skidding=False)
        return each

    return tuple(map(explained, told))
