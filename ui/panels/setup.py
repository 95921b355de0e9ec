"""Character and Recording: whose motion it is, and which frames of it."""

import bpy

from ...bridge.accessors import armature_data, present
from ...bridge.armature.actions import recorded_action
from ...bridge.properties.settings import scene_settings, settings_of
from ...operators.names import OperatorId
from ...operators.solve.common import chosen_armature
from .sidebar import ArmaturePanel, SidebarPanel, lines, optional, settings_in, split


class CharacterPanel(SidebarPanel):
    bl_idname = "HANGTIME_PT_character"
    bl_label = "Character"
    bl_order = 0

    def draw(self, context: bpy.types.Context) -> None:
        layout = split(self)
        armature = chosen_armature(context)
        active = armature.name if armature is not None else "Select an armature"
        layout.prop(scene_settings(context.scene), "armature", placeholder=active)
        if armature is None:
            return
        settings = settings_of(armature)
        layout.prop(settings, "mass")
        optional(layout, settings, "use_height", "Own Height", "height")
        if settings.measured_height > 0.0:
            layout.label(text=f"Measured height: {settings.measured_height:.2f} m")


class BonesPanel(ArmaturePanel):
    bl_idname = "HANGTIME_PT_bones"
    bl_parent_id = CharacterPanel.bl_idname
    bl_label = "Bones"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        parts = settings_in(context).parts
        missing = sum(part.needed and not part.bone for part in parts)
        if missing:
            present(self.layout).label(text=f"{missing} missing", icon="ERROR")

    def draw(self, context: bpy.types.Context) -> None:
        layout = split(self)
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
    bl_idname = "HANGTIME_PT_recording"
    bl_label = "Recording"
    bl_order = 1

    def draw(self, context: bpy.types.Context) -> None:
        layout = split(self)
        armature = present(chosen_armature(context))
        settings = settings_of(armature)
        recorded = recorded_action(armature)
        if recorded is not None:
            layout.label(text=recorded.name, icon="ACTION")
        else:
            layout.label(text="No action is assigned", icon="ERROR")
        optional(layout, settings, "use_range", "Frame Range", "first_frame", "last_frame")
        buttons = layout.row(align=True)
        buttons.operator(OperatorId.ANALYZE, icon="VIEWZOOM")
        buttons.operator(OperatorId.FIT, icon="CON_FOLLOWPATH")
        if settings.fit_quality:
            lines(layout, settings.fit_quality, icon="CHECKMARK")
