"""Character and Recording: whose motion it is, and which frames of it."""

from dataclasses import dataclass

import bpy

from ...bridge.accessors import armature_data, present
from ...bridge.armature.actions import recorded_action
from ...bridge.constraints.bone_mapping import evidence_of
from ...bridge.properties.settings import scene_settings, settings_of
from ...bridge.repairs.unreadable import unreadable_texts
from ...bridge.rows.kind import Icon
from ...operators.names import OperatorId
from ...operators.solve.common import chosen_armature, said
from ...solver.skeleton.mapping import Evidence
from ..drawing.wrapping import wrapped
from .failure import draw_failure
from .menus import BonePresetsMenu
from .sidebar import ArmaturePanel, SidebarPanel, draw_at_work, lines, optional, settings_in, split

FIRST_STEPS = """Import a recorded jump, select it
Press Analyze here
Drag where it lands"""


@dataclass(frozen=True)
class Shown:
    """How it is shown that a bone was found by something."""

    icon: Icon
    text: str


EVIDENCE = {
    Evidence.NAME_AND_SHAPE: Shown("CHECKMARK", "Name and shape agree"),
    Evidence.NAME: Shown("SORTALPHA", "By its name"),
    Evidence.SHAPE: Shown("QUESTION", "By the skeleton's shape alone: check it"),
    Evidence.DISPUTED: Shown("ERROR", "Its shape speaks against its name: check it"),
    Evidence.CHOSEN: Shown("USER", "Chosen by you"),
}


class CharacterPanel(SidebarPanel):
    bl_idname = "HANGTIME_PT_character"
    bl_label = "Character"
    bl_order = 0

    def draw(self, context: bpy.types.Context) -> None:
        layout = split(self)
        armature, scene = chosen_armature(context), scene_settings(context.scene)
        if armature is None:
            lines(layout, FIRST_STEPS, icon="INFO")
            return
        row = layout.row(align=True)
        if scene.pinned:
            row.prop(scene, "armature", text="")
        else:
            row.label(text=armature.name, icon="ARMATURE_DATA")
        row.prop(scene, "pinned", text="", icon="PINNED" if scene.pinned else "UNPINNED")
        settings = settings_of(armature)
        layout.prop(settings, "mass")
        optional(layout, settings, "use_height", "Height (m)", "height")
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
        layout = present(self.layout)
        if missing:
            layout.label(text=f"{missing} missing", icon="ERROR")
        layout.menu(BonePresetsMenu.bl_idname, text="", icon="PRESET")

    def draw(self, context: bpy.types.Context) -> None:
        layout = split(self)
        armature = present(chosen_armature(context))
        settings, bones = settings_of(armature), armature_data(armature)
        if settings.convention:
            layout.label(text=f"Named as by {settings.convention}")
        column = layout.column(align=True)
        for part in settings.parts:
            row = column.row()
            row.alert = part.needed and not part.bone
            row.prop_search(part, "bone", bones, "bones", text=part.name.capitalize())
            evidence = evidence_of(part)
            row.label(text="", icon="BLANK1" if evidence is None else EVIDENCE[evidence].icon)
        seen = {evidence_of(part) for part in settings.parts}
        for evidence, shown in EVIDENCE.items():
            if evidence in seen:
                layout.label(text=shown.text, icon=shown.icon)
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
        layout.prop(settings.loop, "use")
        if settings.loop.use:
            layout.prop(settings.loop, "root")
        if not draw_at_work(layout, OperatorId.ANALYZE):
            layout.operator(OperatorId.ANALYZE, icon="VIEWZOOM")
        draw_failure(layout, context, armature, OperatorId.ANALYZE)
        for fault in unreadable_texts(armature):
            lines(layout.box(), wrapped(context, said(fault)), icon="ERROR")
