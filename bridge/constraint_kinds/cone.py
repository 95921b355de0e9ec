"""Cone: a bone's direction stays within a cone about an axis (thesis 3.3.3)."""

from __future__ import annotations

from math import radians

from ...solver.data.requests import ConeLimit
from ..recipe_syntax.items import BONE, WHEN, Kind, angle, direction, one
from ..recipe_syntax.table import NumberRange, Table
from ..rows.kind import ConstraintKind, FieldDrawing, MenuGroup, Row
from ..rows.row_parts import RowContext, bone_of, direction_of
from ..rows.stored import angle as stored_angle
from ..rows.stored import boolean, vector
from ..rows.times import when_of

HALF_ANGLE = NumberRange("between 0 and 180 degrees", lambda value: 0.0 < value < 180.0)


def _record(row: Row, context: RowContext) -> ConeLimit:
    sideways, forwards = row.stretch
    return ConeLimit(
        row.name,
        bone_of(row, context),
        row.half_angle,
        axis=direction_of(row, row.axis) if row.use_axis else None,
        stretch=(sideways, forwards),
        when=when_of(row, context.clip),
    )


def _draw(fields: FieldDrawing, row: Row) -> None:
    layout = fields.layout
    fields.bone()
    layout.prop(row, "half_angle", slider=True)
    wider = layout.column(align=True)
    wider.prop(row, "stretch", index=0, text="Wider Sideways")
    wider.prop(row, "stretch", index=1, text="Forwards")
    layout.prop(row, "use_axis")
    if row.use_axis:
        layout.column(align=True).prop(row, "axis")
    fields.when()


def _stretch(table: Table, key: str) -> tuple[float, float] | None:
    values = table.pair(key, "[sideways, forwards]")
    if values is not None and min(values) <= 0.0:
        table.refuse(key, f'"{key}" must be above zero in both directions')
    return values


KIND = ConstraintKind(
    name="CONE",
    number=3,
    label="Cone",
    description="Keep a bone's direction within a cone",
    icon="CONE",
    menu=MenuGroup.JOINTS,
    record=_record,
    draw=_draw,
    recipe=Kind(
        "cone",
        ConeLimit,
        (
            BONE,
            angle("half_angle", HALF_ANGLE),
            one("axis", direction),
            one("stretch", _stretch),
            WHEN,
        ),
        needs=(("bone",), ("half_angle",)),
    ),
    fields={
        "half_angle": stored_angle(
            "Half Angle",
            "How far the bone may lean from the cone's axis",
            min=radians(1.0),
            max=radians(179.0),
            default=radians(40.0),
        ),
        "use_axis": boolean(
            "Custom Axis", "Aim the cone yourself instead of along the recording's mean direction"
        ),
        "axis": vector(
            "Axis",
            "Where the bone would point in the armature's rest pose, in its parent",
            subtype="DIRECTION",
            default=(0.0, 0.0, -1.0),
        ),
        "stretch": vector(
            "Stretch",
            "How much wider the cone is sideways, and forwards and backwards",
            size=2,
            min=0.1,
            max=10.0,
            default=(1.0, 1.0),
        ),
    },
)
