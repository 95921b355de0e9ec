"""Constraints and Body Changes: what the artist asks for beside moved contacts."""

import bpy

from ...bridge.accessors import armature_data, present
from ...bridge.constraint_kinds import KINDS
from ...bridge.properties.settings import settings_of
from ...bridge.rows.choices import BodyKind
from ...bridge.rows.kind import Row
from ...operators.lists.row_lists import RowList
from ...operators.names import OperatorId
from ...operators.solve.common import chosen_armature
from .constraint_fields import RowDrawing
from .lists import MET_ICONS, BodyChangeList, ConstraintList, status_counts
from .menus import AddBodyChangeMenu, AddConstraintMenu, ConstraintMoreMenu
from .sidebar import ArmaturePanel, draw_list, optional, settings_in, split


class ConstraintsPanel(ArmaturePanel):
    bl_idname = "HANGTIME_PT_constraints"
    bl_label = "Constraints"
    bl_order = 5

    def draw(self, context: bpy.types.Context) -> None:
        settings = settings_in(context)
        side = draw_list(present(self.layout), ConstraintList, settings, "constraints")
        side.menu(AddConstraintMenu.bl_idname, text="", icon="ADD")
        side.operator(OperatorId.REMOVE_CONSTRAINT, text="", icon="REMOVE")
        side.separator()
        side.menu(ConstraintMoreMenu.bl_idname, text="", icon="DOWNARROW_HLT")
        if len(settings.constraints) > 1:
            side.separator()
            side.operator(OperatorId.MOVE_CONSTRAINT, text="", icon="TRIA_UP").direction = "UP"
            side.operator(OperatorId.MOVE_CONSTRAINT, text="", icon="TRIA_DOWN").direction = "DOWN"


class ConstraintPanel(ArmaturePanel):
    bl_idname = "HANGTIME_PT_constraint"
    bl_parent_id = ConstraintsPanel.bl_idname
    bl_label = ""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        armature = chosen_armature(context)
        return armature is not None and RowList.CONSTRAINTS.chosen(settings_of(armature)) >= 0

    def draw_header(self, context: bpy.types.Context) -> None:
        row = _chosen(present(chosen_armature(context)), RowList.CONSTRAINTS)
        kind = KINDS[row.kind]
        present(self.layout).label(text=kind.label, icon=kind.icon)

    def draw(self, context: bpy.types.Context) -> None:
        layout = split(self)
        armature = present(chosen_armature(context))
        row = _chosen(armature, RowList.CONSTRAINTS)
        _draw_status(layout, row)
        body = layout.column()
        body.active = row.used
        own = _is_own(armature, RowList.CONSTRAINTS)
        KINDS[row.kind].draw(RowDrawing(body, row, armature_data(armature), own), row)


class BodyChangesPanel(ArmaturePanel):
    bl_idname = "HANGTIME_PT_body_changes"
    bl_label = "Body Changes"
    bl_order = 6
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = split(self)
        armature = present(chosen_armature(context))
        settings = settings_of(armature)
        optional(layout, settings, "use_new_mass", "New Mass (kg)", "new_mass")
        layout.prop(settings, "gravity")
        hint = layout.row()
        hint.active, hint.alignment = False, "RIGHT"
        hint.label(text="Moon 1.62, Mars 3.73")
        side = draw_list(layout, BodyChangeList, settings, "body_changes", rows=3)
        side.menu(AddBodyChangeMenu.bl_idname, text="", icon="ADD")
        side.operator(OperatorId.REMOVE_BODY_CHANGE, text="", icon="REMOVE")
        if RowList.BODY_CHANGES.chosen(settings) >= 0:
            _draw_body_change(layout, armature)


def _draw_body_change(layout: bpy.types.UILayout, armature: bpy.types.Object) -> None:
    row = _chosen(armature, RowList.BODY_CHANGES)
    _draw_status(layout, row)
    body = layout.column()
    body.active = row.used
    of = RowList.BODY_CHANGES
    fields = RowDrawing(body, row, armature_data(armature), _is_own(armature, of), of.name)
    if row.kind == BodyKind.LIMB.name:
        fields.bones("Select bones and assign them")
        factors = body.column(align=True)
        factors.prop(row, "length", text="Length ×")
        factors.prop(row, "mass_factor", text="Mass ×")
        return
    if row.kind == BodyKind.SHAPE.name:
        fields.bones("Select bones and assign them")
        body.prop(row, "thickness", text="Thickness ×")
        body.prop(row, "through")
        body.prop(row, "human")
        return
    fields.bone()
    body.prop(row, "by_share")
    body.prop(row, "share" if row.by_share else "mass")
    body.prop(row, "use_offset")
    if row.use_offset:
        body.column(align=True).prop(row, "offset")


def _draw_status(layout: bpy.types.UILayout, row: Row) -> None:
    if row.status:
        line = layout.row()
        line.active = status_counts(row.id_data)
        line.label(text=row.status, icon=MET_ICONS[row.met])


def _chosen(armature: bpy.types.Object, of: RowList) -> Row:
    settings = settings_of(armature)
    return of.rows(settings)[of.chosen(settings)]


def _is_own(armature: bpy.types.Object, of: RowList) -> bool:
    """Whether the chosen row is the artist's, not a linked file's."""
    return of.chosen(settings_of(armature)) >= of.linked(armature)
