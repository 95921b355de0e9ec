"""Aim Cone: where a cone about a limb points, by the handle on its axis."""

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
from .drag_state import ANGLE_STEP, PinDrag
from .limit_mixin import NO_LIMIT, LimitDrag
from .mouse import GIVEN, Pixel, pixel, ray_at


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
            self.report({"ERROR"}, NO_LIMIT)
            return {"CANCELLED"}
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
