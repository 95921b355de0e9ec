"""Contact Force: caps of contact forces, and how slippery the ground is (thesis 3.3)."""

from __future__ import annotations

from enum import Enum

from ...solver.data.faults import AsksNothing
from ...solver.data.requests import ConeShape, ForceRequest
from ..recipe_syntax.items import TOUCHING, WHEN, Kind, choice, number
from ..recipe_syntax.table import ABOVE_ZERO, NOT_NEGATIVE
from ..rows.kind import BoneUse, ConstraintKind, FieldDrawing, MenuGroup, Row
from ..rows.row_parts import RowContext, bones_of
from ..rows.stored import boolean
from ..rows.stored import choice as stored_choice
from ..rows.stored import number as stored_number
from ..rows.times import when_of


class ShapeLabel(Enum):
    """How a friction cone is bounded, as the artist reads it; the names are ConeShape's."""

    EXACT = "Round Cone"
    PYRAMID = "Pyramid"


def _record(row: Row, context: RowContext) -> ForceRequest:
    shape = ConeShape[row.shape]
    if not (row.use_peak or row.use_friction or row.use_match or shape is ConeShape.PYRAMID):
        raise AsksNothing(row.name)
    return ForceRequest(
        row.name,
        friction=row.friction if row.use_friction else None,
        shape=shape,
        peak=row.peak if row.use_peak else None,
        match=row.match if row.use_match else None,
        touching=bones_of(row, context),
        when=when_of(row, context.clip),
    )


def _draw(fields: FieldDrawing, row: Row) -> None:
    layout = fields.layout
    fields.optional(layout, "use_peak", "peak", "Peak (BW)")
    fields.optional(layout, "use_friction", "friction", "Friction")
    layout.prop(row, "shape")
    fields.optional(layout, "use_match", "match", "Keep Forces")
    fields.when()
    fields.bones("Everything that touches then")


KIND = ConstraintKind(
    name="FORCE",
    number=8,
    label="Contact Force",
    description="Cap contact forces, or set how slippery the ground is",
    icon="FORCE_FORCE",
    menu=MenuGroup.CONTACTS,
    record=_record,
    draw=_draw,
    recipe=Kind(
        "force",
        ForceRequest,
        (
            TOUCHING,
            number("friction", NOT_NEGATIVE),
            choice("shape", ConeShape),
            number("peak", ABOVE_ZERO),
            number("match", NOT_NEGATIVE),
            WHEN,
        ),
        needs=(("friction", "shape", "peak", "match"),),
    ),
    bones=BoneUse.TOUCHING,
    on_ground=True,
    fields={
        "use_peak": boolean(
            "Limit Peak", "Cap the largest contact force, for a softer landing", default=True
        ),
        "peak": stored_number(
            "Peak",
            "Largest contact force, in body weights (those on Earth: mass × 9.81 m/s²)",
            min=0.1,
            soft_max=10.0,
            default=3.0,
        ),
        "use_friction": boolean("Custom Friction", "Set how slippery the ground is; 1 otherwise"),
        "friction": stored_number("Friction", min=0.0, soft_max=1.5, default=0.8),
        "shape": stored_choice("Shape", ShapeLabel),
        "use_match": boolean("Keep Forces", "Keep all forces more like the recording's"),
        "match": stored_number("How Strongly", min=1.0, soft_max=100.0, default=10.0),
    },
)
