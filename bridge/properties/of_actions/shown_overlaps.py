"""What is in what, of the recording and of the adapted motion, kept with the adapted action."""

from __future__ import annotations

import json
from dataclasses import astuple, dataclass
from typing import Any

import bpy

from ....solver.data.reports.report import Report
from ...hidden_texts import HiddenText, listed, number, word
from ..action import action_settings

IN = " in "  # between the names, as the solver calls what is in what


@dataclass(frozen=True)
class ShownOverlap:
    """name: such as "Left hand in right thigh". millimetres: at its deepest, at a scene frame."""

    name: str
    millimetres: float
    frame: float

    @property
    def things(self) -> tuple[str, str]:
        """Names of both, in lower case."""
        one, _, other = self.name.lower().partition(IN)
        return one, other


def store_overlaps(action: bpy.types.Action, report: Report) -> None:
    """Keeps the overlaps of a report with its action."""
    recorded = [ShownOverlap(o.name, o.deepest_mm, o.frame) for o in report.recorded_overlaps]
    adapted = [
        ShownOverlap(o.name, o.worst_violation, o.worst_violation_frame) for o in report.overlaps
    ]
    both = [[astuple(each) for each in overlaps] for overlaps in (recorded, adapted)]
    action_settings(action).overlaps = json.dumps(both)


def shown_overlaps(action: bpy.types.Action | None, *, adapted: bool) -> tuple[ShownOverlap, ...]:
    """Of the adapted motion, or of the fit to the recording that it was made from."""
    stored = action_settings(action).overlaps if action is not None else ""
    return OVERLAPS.of(stored)[adapted]


_Both = tuple[tuple[ShownOverlap, ...], tuple[ShownOverlap, ...]]


def _read_overlaps(content: Any) -> _Both:
    recorded, adapted = listed(content)
    return _of_motion(recorded), _of_motion(adapted)


def _of_motion(content: Any) -> tuple[ShownOverlap, ...]:
    rows = map(listed, listed(content))
    return tuple(ShownOverlap(word(name), number(mm), number(at)) for name, mm, at in rows)


OVERLAPS: HiddenText[_Both] = HiddenText("overlaps", _read_overlaps, ((), ()))
