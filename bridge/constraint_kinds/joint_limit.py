"""Joint Limit: how far a joint is bent stays between two angles."""

from __future__ import annotations

from math import degrees, pi, radians

from ...solver.data.faults import AsksNothing
from ...solver.data.requests import AngleLimit, Bound
from ..recipe_syntax.items import BONE, LIMIT_KEYS, LIMITS, WHEN, Kind
from ..rows.kind import ConstraintKind, FieldDrawing, MenuGroup, Row
from ..rows.row_parts import RowContext, bone_of, ordered_bound
from ..rows.stored import angle, boolean
from ..rows.times import when_of

TURN = 2.0 * pi  # beyond which no joint goes
LIMIT_FIELDS = {
    "use_lower": boolean("Use At Least", default=True),
    "lower": angle("At Least", min=-TURN, max=TURN, soft_min=-pi, soft_max=pi),
    "use_upper": boolean("Use At Most", default=True),
    "upper": angle(
        "At Most", min=-TURN, max=TURN, soft_min=-pi, soft_max=pi, default=radians(140.0)
    ),
}


def limits(row: Row) -> Bound:
    """The least and the greatest angle, rad. Raises AsksNothing, CrossedBounds."""
    low = row.lower if row.use_lower else None
    high = row.upper if row.use_upper else None
    if low is None and high is None:
        raise AsksNothing(row.name)
    return ordered_bound(row, low, high, "°", degrees)


def draw_limits(fields: FieldDrawing, _row: Row) -> None:
    """The bone, both angles, and when they hold."""
    fields.bone()
    column = fields.layout.column()
    fields.optional(column, "use_lower", "lower", "At Least")
    fields.optional(column, "use_upper", "upper", "At Most")
    fields.when()


def _record(row: Row, context: RowContext) -> AngleLimit:
    when = when_of(row, context.clip)
    return AngleLimit(row.name, bone_of(row, context), *limits(row), when)


KIND = ConstraintKind(
    name="ANGLE",
    number=2,
    label="Joint Limit",
    description="Keep how far a joint is bent between two angles",
    icon="DRIVER_ROTATIONAL_DIFFERENCE",
    menu=MenuGroup.JOINTS,
    record=_record,
    draw=draw_limits,
    recipe=Kind("angle", AngleLimit, (BONE, LIMITS, WHEN), needs=(("bone",), LIMIT_KEYS)),
    fields=LIMIT_FIELDS,
    short="Bend",
)
