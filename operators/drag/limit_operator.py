"""Drag Joint Limit and Aim Cone: limits of joints by the handles of ends, rims and axes."""

from math import degrees, radians

import bpy
import numpy as np
from mathutils import Matrix, Vector

from ...bridge.accessors import present
from ...bridge.constraint_kinds import cone
from ...bridge.properties.constraint import HangtimeConstraint
from ..names import OperatorId
from ..operator_types import OperatorResult
from ..solve.common import required_armature
from . import rays
from .drag_state import ANGLE_STEP, PinDrag, ValueDrag
from .limit_mixin import NO_LIMIT, LimitDrag
from .mouse import GIVEN, Pixel, pixel, ray_at

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
            return self.refuse(NO_LIMIT)
        low, high = bounds(row, self.end)
        setattr(row, self.end, min(max(self.angle, low), high))
        return {"FINISHED"}

    def take(self, context: bpy.types.Context) -> bool:
        centre, zero, ahead = (np.array(each) for each in (self.centre, self.zero, self.ahead))
        self._circle = rays.Circle(centre, zero, ahead, self.radius)
        if not self._circle.normal.any():
            return False
        value = getattr(self.row, self.end)
        self._drag = ValueDrag(value, *bounds(self.row, self.end), ANGLE_STEP)
        ray = ray_at(context, self._press.at)
        self._seen = rays.scaled(value, 1.0 / self.narrow)
        self._began = self._angle = rays.angle_about(ray, self._circle, self._seen)
        return True

    def pull(self, context: bpy.types.Context, event: bpy.types.Event) -> None:
        self._angle = rays.angle_about(ray_at(context, pixel(event)), self._circle, self._angle)
        now = rays.scaled(self._seen + self._angle - self._began, self.narrow)
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


class AimConeOperator(LimitDrag, bpy.types.Operator):
    bl_idname = OperatorId.AIM_CONE
    bl_label = "Aim Cone"
    bl_description = "Turn the cone about its joint"
    bl_options = {"REGISTER", "UNDO", "BLOCKING", "INTERNAL"}

    tip: bpy.props.FloatVectorProperty(
        description="A point on the cone's axis, world", options=GIVEN
    )
    turn: bpy.props.FloatVectorProperty(
        description="From directions in the world now to the constraint's axis",
        size=(3, 3),
        subtype="MATRIX",
        options=GIVEN,
    )
    axis: bpy.props.FloatVectorProperty(name="Axis", subtype="DIRECTION", default=(0.0, 0.0, -1.0))

    def execute(self, context: bpy.types.Context) -> OperatorResult:
        """In scripts and for redo."""
        self._armature = required_armature(context)
        row = self.find_row()
        if row is None or row.kind != cone.KIND.name:
            return self.refuse(NO_LIMIT)
        row.use_axis, row.axis = True, self.axis
        return {"FINISHED"}

    def take(self, context: bpy.types.Context) -> bool:
        self._was = (self.row.use_axis, Vector(self.row.axis))
        self._sight = np.array(
            (present(context.region_data).view_rotation @ Vector((0.0, 0.0, 1.0))).to_tuple()
        )
        self._drag = PinDrag(tuple(self.tip))
        return self._aim(context, self._press.at) is not None

    def pull(self, context: bpy.types.Context, event: bpy.types.Event) -> None:
        began, now = (self._aim(context, at) for at in (self._press.at, pixel(event)))
        if began is None or now is None:
            return
        x, y, z = (float(each) for each in now - began)
        arm = np.array(self._drag.move((x, y, z), precise=event.shift)) - np.array(self.centre)
        axis = rays.unit(np.array(Matrix(self.turn)) @ arm)
        self.row.use_axis = True
        self.row.axis = rays.rounded(axis, ANGLE_STEP) if event.ctrl else axis

    def put_back(self, row: HangtimeConstraint) -> None:
        self._drag.put_back()
        row.use_axis, row.axis = self._was

    def let_go(self) -> bool:
        self.axis = self.row.axis
        return self._drag.let_go()

    def text(self) -> str:
        x, y, z = self.row.axis
        return f"Axis {x:.2f} {y:.2f} {z:.2f}"

    def _aim(self, context: bpy.types.Context, at: Pixel) -> rays.Vector | None:
        """On the plane through the tip that faces the viewer."""
        return rays.on_plane(ray_at(context, at), self.tip, self._sight)


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
