"""Torque Limit: how strong joints are; zero makes them limp."""

from __future__ import annotations

from enum import Enum

from ...solver.data.requests import TorqueLimit
from ..recipe_syntax.items import BONES, WHEN, Kind, number, whole
from ..recipe_syntax.table import NOT_NEGATIVE, NumberRange
from ..rows.kind import BoneUse, ConstraintKind, FieldDrawing, MenuGroup, Row
from ..rows.row_parts import RowContext, some_bones
from ..rows.stored import boolean, choice
from ..rows.stored import number as stored_number
from ..rows.stored import whole as stored_whole
from ..rows.times import when_of

DOF = NumberRange("0, 1 or 2", lambda value: value in (0.0, 1.0, 2.0))


class TorqueBy(Enum):
    """How a torque's bound is given."""

    NEWTON_METRES = "Newton Metres"
    SHARE = "Share of the Recording's Peak"


def _record(row: Row, context: RowContext) -> TorqueLimit:
    by_share = TorqueBy[row.torque_by] is TorqueBy.SHARE
    return TorqueLimit(
        row.name,
        some_bones(row, context),
        bound=None if by_share else row.torque,
        share=row.share if by_share else None,
        value=row.torque_value,
        dof=row.dof if row.use_dof else None,
        when=when_of(row, context.clip),
    )


def _draw(fields: FieldDrawing, row: Row) -> None:
    layout = fields.layout
    fields.bones("Select bones and assign them")
    layout.prop(row, "torque_by")
    layout.prop(row, "share" if TorqueBy[row.torque_by] is TorqueBy.SHARE else "torque")
    fields.when()
    layout.prop(row, "torque_value")
    fields.optional(layout, "use_dof", "dof", "One Angle")


def _added(_armature: object, row: Row, _bones: object) -> None:
    """By a share: what joints give in newton metres is known to few."""
    row.torque_by = TorqueBy.SHARE.name


KIND = ConstraintKind(
    name="TORQUE",
    number=5,
    label="Torque Limit",
    description="Cap how strong joints are; zero makes them limp",
    icon="FORCE_MAGNETIC",
    menu=MenuGroup.JOINTS,
    record=_record,
    draw=_draw,
    recipe=Kind(
        "torque",
        TorqueLimit,
        (
            BONES,
            number("bound", NOT_NEGATIVE),
            number("share", NOT_NEGATIVE),
            number("value"),
            whole("dof", DOF),
            WHEN,
        ),
        needs=(("bones",), ("bound", "share")),
        excludes=(("bound", "share"),),
    ),
    bones=BoneUse.SEVERAL,
    added=_added,
    short="Torque",
    fields={
        "torque_by": choice("In", TorqueBy),
        "torque": stored_number(
            "At Most (N·m)",
            "Largest torque of the joint; zero makes it limp",
            min=0.0,
            soft_max=500.0,
            default=50.0,
        ),
        "share": stored_number(
            "At Most",
            "Of the largest torque that the recording needs; zero makes the joint limp",
            subtype="FACTOR",
            min=0.0,
            soft_max=1.0,
            default=0.5,
        ),
        "torque_value": stored_number("About (N·m)", "The torque about which it is bounded"),
        "use_dof": boolean("One Angle", "Bound only one of the joint's angles"),
        "dof": stored_whole("Angle", min=0, max=2),
    },
)
