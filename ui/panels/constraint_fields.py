"""The fields of a constraint, drawn in the sidebar; its kind says which."""

from dataclasses import dataclass

import bpy

from ...bridge.constraint_kinds import KINDS
from ...bridge.rows.choices import Span
from ...bridge.rows.kind import Row
from ...operators.names import OperatorId
from .sidebar import optional

Layout = bpy.types.UILayout


def draw_constraint(layout: Layout, row: Row, bones: bpy.types.Armature, *, own: bool) -> None:
    """The fields of a row. bones: the armature's data. own: whether its bones may be changed."""
    KINDS[row.kind].draw(RowDrawing(layout, row, bones, own), row)


@dataclass(frozen=True)
class RowDrawing:
    """What kinds draw their fields with (bridge/rows/kind.py FieldDrawing)."""

    layout: Layout
    row: Row
    data: bpy.types.Armature
    own: bool

    def bone(self) -> None:
        draw_bone(self.layout, self.row, self.data, own=self.own)

    def bones(self, none: str) -> None:
        draw_bones(self.layout, self.row, self.data, "CONSTRAINTS", none, own=self.own)

    def phase(self) -> None:
        self._phase(self.layout)

    def when(self) -> None:
        column = self.layout.column(align=True)
        column.prop(self.row, "span")
        if self.row.span == Span.PHASE.name:
            self._phase(column)
            column.prop(self.row, "instant")
        elif self.row.span == Span.FRAMES.name:
            column.prop(self.row, "first_frame")
            column.prop(self.row, "last_frame")
        elif self.row.span == Span.FRAME.name:
            column.prop(self.row, "first_frame", text="Frame")

    def optional(self, layout: Layout, use: str, value: str, heading: str) -> None:
        optional(layout, self.row, use, heading, value)

    def place_button(self, layout: Layout) -> None:
        layout.operator(OperatorId.PLACE_CONSTRAINT, icon="CON_LOCLIKE")

    def _phase(self, layout: Layout) -> None:
        line = layout.row(align=True)
        line.alert = not self.row.phase
        line.prop(self.row, "phase", icon="PREVIEW_RANGE")


def draw_bone(layout: Layout, row: Row, data: bpy.types.Armature, *, own: bool) -> None:
    """The one bone that a row is about. data: the armature's."""
    line = layout.row()
    line.enabled = own
    if not row.bones:
        line.label(text="Select a bone and assign it", icon="ERROR")
        return
    line.alert = row.bones[0].name not in data.bones
    line.prop_search(row.bones[0], "name", data, "bones", text="Bone")


def draw_bones(
    layout: Layout, row: Row, data: bpy.types.Armature, of: str, none: str, *, own: bool
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
