"""Hold: a frame is repeated for some time, as a phase of its own (thesis 6.3)."""

from __future__ import annotations

from ...solver.data.requests import Hold
from ..recipe_syntax.items import Kind, flag, number
from ..recipe_syntax.table import ABOVE_ZERO
from ..rows.choices import HOLD
from ..rows.kind import BoneUse, ConstraintKind, FieldDrawing, MenuGroup, NewRange, Row, frame_text
from ..rows.row_parts import RowContext
from ..rows.stored import boolean
from .timing import SECONDS


def _record(row: Row, _context: RowContext) -> Hold:
    return Hold(row.name, row.first_frame, row.seconds, row.ends)


def _draw(fields: FieldDrawing, row: Row) -> None:
    column = fields.layout.column(align=True)
    column.prop(row, "first_frame", text="Frame")
    column.prop(row, "seconds")
    fields.layout.prop(row, "ends")


KIND = ConstraintKind(
    name=HOLD,
    number=10,
    label="Hold",
    description="Repeat a frame for some time",
    icon="PAUSE",
    menu=MenuGroup.TIME,
    record=_record,
    draw=_draw,
    recipe=Kind(
        "hold",
        Hold,
        (number("frame"), number("seconds", ABOVE_ZERO), flag("ends")),
        needs=(("frame",), ("seconds",)),
    ),
    bones=BoneUse.NONE,
    range=NewRange.FRAME,
    told=frame_text,
    fields={
        "seconds": SECONDS,
        "ends": boolean("Ends There", "Leave out the recording after the held frame"),
    },
)
