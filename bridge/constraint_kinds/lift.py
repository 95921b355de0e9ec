"""Lift Off: feet or hands that touch in a phase touch no more."""

from __future__ import annotations

from ...solver.data.requests import Lift
from ..recipe_syntax.items import TOUCHING, Kind, phase
from ..rows.kind import BoneUse, ConstraintKind, FieldDrawing, MenuGroup, NewRange, Row, phase_text
from ..rows.row_parts import RowContext, bones_of
from ..rows.times import phase_of


def _record(row: Row, context: RowContext) -> Lift:
    return Lift(row.name, phase_of(row, context.clip), bones_of(row, context))


def _draw(fields: FieldDrawing, _row: Row) -> None:
    fields.phase()
    fields.bones("Everything that touches then")


KIND = ConstraintKind(
    name="LIFT",
    number=1,
    label="Lift Off",
    description="Let feet or hands that touch in a phase touch no more",
    icon="TRIA_UP_BAR",
    menu=MenuGroup.CONTACTS,
    record=_record,
    draw=_draw,
    recipe=Kind("lift", Lift, (phase("phase"), TOUCHING), needs=(("phase",),)),
    bones=BoneUse.TOUCHING,
    range=NewRange.PHASE_ALWAYS,
    on_ground=True,
    told=phase_text,
)
