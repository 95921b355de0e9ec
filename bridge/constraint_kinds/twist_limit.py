"""Twist Limit: how far a bone is turned about itself stays between two angles (thesis 3.3.3)."""

from __future__ import annotations

from collections.abc import Sequence
from math import radians
from typing import TYPE_CHECKING

from ...solver.data.requests import TwistLimit
from ..recipe_syntax.items import BONE, LIMIT_KEYS, LIMITS, WHEN, Kind
from ..rows.kind import ConstraintKind, MenuGroup, Row
from ..rows.row_parts import RowContext, bone_of
from ..rows.times import when_of
from .joint_limit import LIMIT_FIELDS, draw_limits, limits

if TYPE_CHECKING:
    import bpy

USUAL_TWIST = radians(45.0)


def _record(row: Row, context: RowContext) -> TwistLimit:
    when = when_of(row, context.clip)
    return TwistLimit(row.name, bone_of(row, context), *limits(row), when)


def _added(_armature: bpy.types.Object, row: Row, _bones: Sequence[str]) -> None:
    row.lower, row.upper = -USUAL_TWIST, USUAL_TWIST


KIND = ConstraintKind(
    name="TWIST",
    number=4,
    label="Twist Limit",
    description="Keep how far a bone is turned about itself between two angles",
    icon="FORCE_VORTEX",
    menu=MenuGroup.JOINTS,
    record=_record,
    draw=draw_limits,
    recipe=Kind("twist", TwistLimit, (BONE, LIMITS, WHEN), needs=(("bone",), LIMIT_KEYS)),
    fields=LIMIT_FIELDS,
    short="Twist",
    added=_added,
)
