"""Orientation: a bone, such as the hips, is turned or tilted in the world."""

from __future__ import annotations

from ...solver.data.requests import OrientationRequest
from ..recipe_syntax.items import BONE, SLACK, WHEN, Kind, angle
from ..rows.kind import ConstraintKind, FieldDrawing, MenuGroup, NewRange, Row
from ..rows.row_parts import RowContext, bone_of
from ..rows.stored import angle as stored_angle
from ..rows.times import when_of
from .pose import STORED_SLACK


def _record(row: Row, context: RowContext) -> OrientationRequest:
    when = when_of(row, context.clip)
    return OrientationRequest(row.name, bone_of(row, context), when, row.turn, row.tilt, row.slack)


def _draw(fields: FieldDrawing, row: Row) -> None:
    fields.bone()
    column = fields.layout.column(align=True)
    for field in ("turn", "tilt", "slack"):
        column.prop(row, field)
    fields.when()


KIND = ConstraintKind(
    name="ORIENTATION",
    number=7,
    label="Orientation",
    description="Turn or tilt a bone, such as the hips, in the world",
    icon="ORIENTATION_GIMBAL",
    menu=MenuGroup.POSES,
    record=_record,
    draw=_draw,
    recipe=Kind(
        "orientation",
        OrientationRequest,
        (BONE, angle("turn"), angle("tilt"), SLACK, WHEN),
        needs=(("bone",),),
    ),
    range=NewRange.FRAME,
    short="Turn",
    fields={
        "turn": stored_angle("Turn", "About the vertical, counter-clockwise seen from above"),
        "tilt": stored_angle("Tilt", "Forwards"),
        "slack": STORED_SLACK,
    },
)
