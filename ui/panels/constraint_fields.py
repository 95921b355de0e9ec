"""The fields of a constraint or body change, drawn in the sidebar; its kind says which."""

from dataclasses import dataclass

import bpy

from ...bridge.rows.choices import Span
from ...bridge.rows.kind import Row
from ...operators.lists.row_lists import RowList
from ...operators.names import OperatorId
from .sidebar import optional

Layout = bpy.types.UILayout


@dataclass(frozen=True)
class RowDrawing:
    """What kinds draw their fields with (bridge/rows/kind.py FieldDrawing).

    data: the armature's. own: whether the row's bones may be changed. of: the name of its list.
    """

    layout: Layout
    row: Row
    data: bpy.types.Armature
    own: bool
    of: str = RowList.CONSTRAINTS.name

    def bone(self) -> None:
        """The one bone that the row is about."""
        line = self.layout.row()
        line.enabled = self.own
        if not self.row.bones:
            line.label(text="Select a bone and assign it", icon="ERROR")
            return
        line.alert = self.row.bones[0].name not in self.data.bones
        line.prop_search(self.row.bones[0], "name", self.data, "bones", text="Bone")

    def bones(self, none: str) -> None:
        """All bones of the row. none: what no bones mean."""
        column = self.layout.column(align=True)
        column.enabled = self.own
        for index, bone in enumerate(self.row.bones):
            line = column.row(align=True)
            line.alert = bool(bone.name) and bone.name not in self.data.bones
            text = "Bones" if index == 0 else " "
            line.prop_search(bone, "name", self.data, "bones", text=text)
            remove = line.operator(OperatorId.REMOVE_BONE, text="", icon="REMOVE")
            remove.of, remove.index = self.of, index
        if not self.row.bones:
            column.label(text=none, icon="INFO")
        buttons = column.row(align=True)
        buttons.operator(OperatorId.ASSIGN_BONES, icon="RESTRICT_SELECT_OFF").of = self.of
        buttons.operator(OperatorId.ADD_BONE, text="", icon="ADD").of = self.of

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
