"""Timing: a phase lasts longer or shorter (thesis 6.2)."""

from __future__ import annotations

from enum import Enum

from ...solver.data.requests import PhaseTiming
from ..recipe_syntax.items import Kind, number, phase
from ..recipe_syntax.table import ABOVE_ZERO
from ..rows.kind import BoneUse, ConstraintKind, FieldDrawing, MenuGroup, NewRange, Row, phase_text
from ..rows.row_parts import RowContext
from ..rows.stored import choice
from ..rows.stored import number as stored_number
from ..rows.times import phase_of


class TimingBy(Enum):
    """How a phase's duration is given."""

    FACTOR = "Factor"
    SECONDS = "Seconds"


SECONDS = stored_number("Seconds", min=0.0, soft_max=5.0, default=0.5)


def by_factor(row: Row) -> bool:
    """Whether a row gives its phase's duration as a factor, not in seconds."""
    return TimingBy[row.timing_by] is TimingBy.FACTOR


def _record(row: Row, context: RowContext) -> PhaseTiming:
    phase = phase_of(row, context.clip)
    if by_factor(row):
        return PhaseTiming(row.name, phase, factor=row.factor)
    return PhaseTiming(row.name, phase, seconds=row.seconds)


def _draw(fields: FieldDrawing, row: Row) -> None:
    fields.phase()
    fields.layout.prop(row, "timing_by")
    fields.layout.prop(row, "factor" if by_factor(row) else "seconds")


KIND = ConstraintKind(
    name="TIMING",
    number=9,
    label="Timing",
    description="Let a phase last longer or shorter",
    icon="TIME",
    menu=MenuGroup.TIME,
    record=_record,
    draw=_draw,
    recipe=Kind(
        "timing",
        PhaseTiming,
        (phase("phase"), number("factor", ABOVE_ZERO), number("seconds", ABOVE_ZERO)),
        needs=(("phase",), ("factor", "seconds")),
        excludes=(("factor", "seconds"),),
    ),
    bones=BoneUse.NONE,
    range=NewRange.PHASE_ALWAYS,
    told=phase_text,
    fields={
        "timing_by": choice("By", TimingBy),
        "factor": stored_number("Times", min=0.1, max=10.0, default=1.0),
        "seconds": SECONDS,
    },
)
