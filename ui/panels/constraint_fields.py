"""The fields of a constraint, for each kind those that count."""

from __future__ import annotations

from collections.abc import Callable

import bpy

from ...bridge.properties.kinds import (
    ConstraintKind,
    PointAxes,
    PoseSource,
    Span,
    TimingBy,
    TorqueBy,
)
from ...operators.names import OperatorId

AXIS_NAMES = {
    PointAxes.WORLD.name: ("X", "Y", "Z"),
    PointAxes.TRAVEL.name: ("Forward", "Left", "Up"),
    PointAxes.SURFACE.name: ("Along", "Across", "Out"),
}
Row = bpy.types.PropertyGroup
Layout = bpy.types.UILayout


def draw_constraint(layout: Layout, row: Row, bones: bpy.types.ID, *, own: bool) -> None:
    """The fields of a row. bones: the armature's data. own: whether its bones may be changed."""
    FIELDS[ConstraintKind[row.kind]](layout, row, _Bones(bones, own))


class _Bones:
    """Draws which bones a row is about."""

    def __init__(self, data: bpy.types.ID, own: bool) -> None:
        self.data = data
        self.own = own

    def one(self, layout: Layout, row: Row) -> None:
        draw_bone(layout, row, self.data, own=self.own)

    def several(self, layout: Layout, row: Row, none: str) -> None:
        draw_bones(layout, row, self.data, "CONSTRAINTS", none, own=self.own)


def draw_bone(layout: Layout, row: Row, data: bpy.types.ID, *, own: bool) -> None:
    """The one bone that a row is about. data: the armature's."""
    line = layout.row()
    line.enabled = own
    if not row.bones:
        line.label(text="Select a bone and assign it", icon="ERROR")
        return
    line.alert = row.bones[0].name not in data.bones
    line.prop_search(row.bones[0], "name", data, "bones", text="Bone")


def draw_bones(
    layout: Layout, row: Row, data: bpy.types.ID, of: str, none: str, *, own: bool
) -> None:
    """All bones of a row. of: the list's name. none: what no bones mean."""
    column = layout.column(align=True)
    column.enabled = own
    for index, bone in enumerate(row.bones):
        line = column.row(align=True)
        line.alert = bool(bone.name) and bone.name not in data.bones
        text = "Bones" if index == 0 else " "
        line.prop_search(bone, "name", data, "bones", text=text)
        remove = line.operator(OperatorId.REMOVE_BONE, text="", icon="REMOVE")
        remove.of, remove.index = of, index
    if not row.bones:
        column.label(text=none, icon="INFO")
    buttons = column.row(align=True)
    buttons.operator(OperatorId.ASSIGN_BONES, icon="RESTRICT_SELECT_OFF").of = of
    buttons.operator(OperatorId.ADD_BONE, text="", icon="ADD").of = of


# ---------------------------------------------------------------- when


def _when(layout: Layout, row: Row) -> None:
    column = layout.column(align=True)
    column.prop(row, "span")
    if row.span == Span.PHASE.name:
        _phase(column, row)
        column.prop(row, "instant")
    elif row.span == Span.FRAMES.name:
        column.prop(row, "first_frame")
        column.prop(row, "last_frame")
    elif row.span == Span.FRAME.name:
        column.prop(row, "first_frame", text="Frame")


def _phase(layout: Layout, row: Row) -> None:
    line = layout.row(align=True)
    line.alert = not row.phase
    line.prop(row, "phase", icon="PREVIEW_RANGE")


def _optional(layout: Layout, row: Row, use: str, value: str, heading: str) -> None:
    """A value behind a checkbox, in one line."""
    line = layout.row(heading=heading)
    line.prop(row, use, text="")
    field = line.row()
    field.active = getattr(row, use)
    field.prop(row, value, text="")


# ---------------------------------------------------------------- by kind


def _point(layout: Layout, row: Row, bones: _Bones) -> None:
    bones.one(layout, row)
    layout.prop(row, "use_offset")
    if row.use_offset:
        layout.column(align=True).prop(row, "offset")
    layout.prop(row, "target")
    place = layout.column()
    place.active = row.target is None
    place.prop(row, "use_place")
    if row.use_place and row.target is None:
        place.column(align=True).prop(row, "place")
        place.operator(OperatorId.PLACE_CONSTRAINT, icon="CON_LOCLIKE")
    _when(layout, row)
    layout.prop(row, "use_bounds")
    if row.use_bounds:
        _bounds(layout, row)
    layout.prop(row, "environment")
    if row.environment:
        layout.prop(row, "grip")


def _bounds(layout: Layout, row: Row) -> None:
    layout.prop(row, "axes")
    if row.axes == PointAxes.SURFACE.name:
        layout.column(align=True).prop(row, "normal")
    table = layout.column(align=True)
    table.use_property_split = False
    head = table.row(align=True)
    for text in ("", "At Least", "At Most"):
        head.label(text=text)
    for axis, name in enumerate(AXIS_NAMES[row.axes]):
        line = table.row(align=True)
        line.prop(row, "bound_axes", index=axis, text=name, toggle=True)
        for use, value in (("bound_below", "at_least"), ("bound_above", "at_most")):
            cell = line.row(align=True)
            cell.active = row.bound_axes[axis]
            cell.prop(row, use, index=axis, text="")
            field = cell.row(align=True)
            field.active = getattr(row, use)[axis]
            field.prop(row, value, index=axis, text="")
    if not row.use_place and row.target is None and not row.environment:
        layout.label(text="From the floor and the world's origin", icon="INFO")


def _lift(layout: Layout, row: Row, bones: _Bones) -> None:
    _phase(layout, row)
    bones.several(layout, row, "Everything that touches then")


def _angle(layout: Layout, row: Row, bones: _Bones) -> None:
    bones.one(layout, row)
    column = layout.column()
    _optional(column, row, "use_lower", "lower", "At Least")
    _optional(column, row, "use_upper", "upper", "At Most")
    _when(layout, row)


def _cone(layout: Layout, row: Row, bones: _Bones) -> None:
    bones.one(layout, row)
    layout.prop(row, "half_angle", slider=True)
    wider = layout.column(align=True)
    wider.prop(row, "stretch", index=0, text="Wider Sideways")
    wider.prop(row, "stretch", index=1, text="Forwards")
    layout.prop(row, "use_axis")
    if row.use_axis:
        layout.column(align=True).prop(row, "axis")
    _when(layout, row)


def _torque(layout: Layout, row: Row, bones: _Bones) -> None:
    bones.several(layout, row, "Select bones and assign them")
    layout.prop(row, "torque_by")
    if row.torque_by == TorqueBy.SHARE.name:
        layout.prop(row, "share")
    else:
        layout.prop(row, "torque")
    _when(layout, row)
    layout.prop(row, "torque_value")
    _optional(layout, row, "use_dof", "dof", "One Angle")


def _pose(layout: Layout, row: Row, bones: _Bones) -> None:
    bones.several(layout, row, "The whole body")
    layout.prop(row, "source")
    if row.source == PoseSource.FIT.name:
        _optional(layout, row, "use_pose_frame", "pose_frame", "Other Frame")
    layout.prop(row, "hard")
    layout.prop(row, "slack" if row.hard else "weight")
    _when(layout, row)


def _orientation(layout: Layout, row: Row, bones: _Bones) -> None:
    bones.one(layout, row)
    column = layout.column(align=True)
    column.prop(row, "turn")
    column.prop(row, "tilt")
    column.prop(row, "slack")
    _when(layout, row)


def _force(layout: Layout, row: Row, bones: _Bones) -> None:
    _optional(layout, row, "use_peak", "peak", "Peak (BW)")
    _optional(layout, row, "use_friction", "friction", "Friction")
    layout.prop(row, "shape")
    _optional(layout, row, "use_match", "match", "Keep Forces")
    _when(layout, row)
    bones.several(layout, row, "Everything that touches then")


def _timing(layout: Layout, row: Row, _bones: _Bones) -> None:
    _phase(layout, row)
    layout.prop(row, "timing_by")
    layout.prop(row, "factor" if row.timing_by == TimingBy.FACTOR.name else "seconds")


def _hold(layout: Layout, row: Row, _bones: _Bones) -> None:
    column = layout.column(align=True)
    column.prop(row, "first_frame", text="Frame")
    column.prop(row, "seconds")
    layout.prop(row, "ends")


FIELDS: dict[ConstraintKind, Callable[[Layout, Row, _Bones], None]] = {
    ConstraintKind.POINT: _point,
    ConstraintKind.LIFT: _lift,
    ConstraintKind.ANGLE: _angle,
    ConstraintKind.CONE: _cone,
    ConstraintKind.TWIST: _angle,
    ConstraintKind.TORQUE: _torque,
    ConstraintKind.POSE: _pose,
    ConstraintKind.ORIENTATION: _orientation,
    ConstraintKind.FORCE: _force,
    ConstraintKind.TIMING: _timing,
    ConstraintKind.HOLD: _hold,
}
