"""Drag Joint Limit: an end of a joint's limit, or how wide a cone is, by its handle."""

from math import degrees, radians

import bpy
import numpy as np

from ...bridge.properties.constraint import HangtimeConstraint
from ..names import OperatorId
from ..operator_types import OperatorResult
from ..solve.common import required_armature
from .drag_state import ANGLE_STEP, ValueDrag
from .limit_mixin import NO_LIMIT, LimitDrag
from .mouse import GIVEN, pixel, ray_at
from .rays import Circle, angle_about, scaled

END_LABELS = {"lower": "At least", "upper": "At most", "half_angle": "Half angle"}


class DragLimitOperator(LimitDrag, bpy.types.Operator):
    bl_idname = OperatorId.DRAG_LIMIT
    bl_label = "Drag Joint Limit"
    bl_description = "Change how far the joint may turn, or how wide the cone is"
    bl_options = {"REGISTER", "UNDO", "BLOCKING", "INTERNAL"}

    end: bpy.props.EnumProperty(
        name="End",
        items=[("lower", "At Least", ""), ("upper", "At Most", ""), ("half_angle", "Cone", "")],
        options=GIVEN,
    )
    zero: bpy.props.FloatVectorProperty(
        description="Where the angle is zero, unit vector, world", options=GIVEN
    )
    ahead: bpy.props.FloatVectorProperty(description="Where it is a right angle", options=GIVEN)
    radius: bpy.props.FloatProperty(default=1.0, options=GIVEN)
    narrow: bpy.props.FloatProperty(
        description="How much narrower a stretched cone is there", default=1.0, options=GIVEN
    )
    angle: bpy.props.FloatProperty(name="Angle", subtype="ANGLE")

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        """In scripts and for redo: sets the angle, within its bounds."""
        self._armature = required_armature(context)
        row = self.find_row()
        if row is None:
            self.report({"ERROR"}, NO_LIMIT)
            return {"CANCELLED"}
        low, high = bounds(row, self.end)
        setattr(row, self.end, min(max(self.angle, low), high))
        return {"FINISHED"}

    def take(self, context: bpy.types.Context) -> bool:
        centre, zero, ahead = (np.array(each) for each in (self.centre, self.zero, self.ahead))
        self._circle = Circle(centre, zero, ahead, self.radius)
        if not self._circle.normal.any():
            return False
        value = getattr(self.row, self.end)
        self._drag = ValueDrag(value, *bounds(self.row, self.end), ANGLE_STEP)
        ray = ray_at(context, self._press.at)
        self._seen = scaled(value, 1.0 / self.narrow)
        self._began = self._angle = angle_about(ray, self._circle, self._seen)
        return True

    def pull(self, context: bpy.types.Context, event: bpy.types.Event) -> None:
        self._angle = angle_about(ray_at(context, pixel(event)), self._circle, self._angle)
        now = scaled(self._seen + self._angle - self._began, self.narrow)
        value = self._drag.move(now - self._drag.start, precise=event.shift, snap=event.ctrl)
        setattr(self.row, self.end, value)

    def put_back(self, row: HangtimeConstraint) -> None:
        setattr(row, self.end, self._drag.put_back())

    def let_go(self) -> bool:
        self.angle = self._drag.value
        return self._drag.let_go()

    def text(self) -> str:
        change = degrees(self._drag.value - self._drag.start)
        return f"{END_LABELS[self.end]} {degrees(self._drag.value):.1f}° ({change:+.1f}°)"


def bounds(row: HangtimeConstraint, end: str) -> tuple[float, float]:
    """Range of an end of a limit, rad: its own bounds, and not past the other end."""
    if end == "half_angle":
        return radians(1.0), radians(179.0)
    low, high = radians(-180.0), radians(180.0)
    if end == "lower" and row.use_upper:
        high = min(high, row.upper)
    if end == "upper" and row.use_lower:
        low = max(low, row.lower)
    return low, high
