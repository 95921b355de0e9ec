"""Character and Recording: whose motion it is, and which frames of it."""

from __future__ import annotations

import bpy

from ...bridge.accessors import armature_data, present
from ...bridge.armature.actions import recorded_action
from ...bridge.properties.settings import scene_settings, settings_of
from ...operators.names import OperatorId, PanelId
from ...operators.solve.common import chosen_armature
from .sidebar import ArmaturePanel, SidebarPanel, lines, settings_in, split


class CharacterPanel(SidebarPanel):
    bl_idname = PanelId.CHARACTER
    bl_label = "Character"
    bl_order = 0

    def draw(self, context: bpy.types.Context) -> None:
        layout = present(self.layout)
        split(layout)
        armature = chosen_armature(context)
        active = armature.name if armature is not None else "Select an armature"
        layout.prop(scene_settings(context.scene), "armature", placeholder=active)
        if armature is None:
            return
        settings = settings_of(armature)
        layout.prop(settings, "mass")
        height = layout.row(heading="Own Height")
        height.prop(settings, "use_height", text="")
        value = height.row()
        value.active = settings.use_height
        value.prop(settings, "height", text="")
        if settings.measured_height > 0.0:
            layout.label(text=f"Measured height: {settings.measured_height:.2f} m")


class BonesPanel(ArmaturePanel):
    bl_idname = PanelId.BONES
    bl_parent_id = PanelId.CHARACTER
    bl_label = "Bones"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        parts = settings_in(context).parts
        missing = sum(part.needed and not part.bone for part in parts)
        if missing:
            present(self.layout).label(text=f"{missing} missing", icon="ERROR")

    def draw(self, context: bpy.types.Context) -> None:
        layout = present(self.layout)
        split(layout)
        armature = present(chosen_armature(context))
        settings, bones = settings_of(armature), armature_data(armature)
        column = layout.column(align=True)
        for part in settings.parts:
            row = column.row()
            row.alert = part.needed and not part.bone
            row.prop_search(part, "bone", bones, "bones", text=part.name.capitalize())
        layout.operator(OperatorId.FIND_BONES, icon="BONE_DATA")
        layout.prop(settings, "mass_table")


class RecordingPanel(ArmaturePanel):
    bl_idname = PanelId.RECORDING
    bl_label = "Recording"
    bl_order = 1

    def draw(self, context: bpy.types.Context) -> None:
        layout = present(self.layout)
        split(layout)
        armature = present(chosen_armature(context))
        settings = settings_of(armature)
        recorded = recorded_action(armature)
        if recorded is not None:
            layout.label(text=recorded.name, icon="ACTION")
        else:
            layout.label(text="No action is assigned", icon="ERROR")
        span = layout.row(heading="Frame Range")
        span.prop(settings, "use_range", text="")
        frames = span.row(align=True)
        frames.active = settings.use_range
        frames.prop(settings, "first_frame", text="")
        frames.prop(settings, "last_frame", text="")
        buttons = layout.row(align=True)
        buttons.operator(OperatorId.ANALYZE, icon="VIEWZOOM")
        buttons.operator(OperatorId.FIT, icon="CON_FOLLOWPATH")
        if settings.fit_quality:
            lines(layout, settings.fit_quality, icon="CHECKMARK")
