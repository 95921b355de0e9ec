"""Solve, Result and Export."""

from textwrap import fill

import bpy

from ...bridge.accessors import present
from ...bridge.properties.settings import action_settings
from ...operators.names import OperatorId
from ...operators.solve.session import session
from ..drawing.editor import ui_scale
from .sidebar import ArmaturePanel, lines, settings_in, split

CHARACTER_PX = 7.5  # at an interface scale of 1, with room for the icon


class SolvePanel(ArmaturePanel):
    bl_idname = "HANGTIME_PT_solve"
    bl_label = "Solve"
    bl_order = 6

    def draw(self, context: bpy.types.Context) -> None:
        layout = present(self.layout)
        solving = session().solving
        if solving is not None:
            layout.progress(factor=solving.share, text=solving.doing.capitalize())
            row = layout.row(align=True)
            row.operator(OperatorId.USE_BEST, icon="CHECKMARK")
            row.operator(OperatorId.CANCEL, icon="X")
            return
        row = layout.row(align=True)
        row.scale_y = 1.5
        row.operator(OperatorId.ADAPT, icon="PLAY")
        row.operator(OperatorId.REFINE, icon="SMOOTHCURVE")
        if session().failure:
            width = present(context.region).width / (CHARACTER_PX * ui_scale(context))
            lines(layout, fill(session().failure, max(20, int(width))), icon="ERROR")
        if session().best is not None:
            layout.operator(OperatorId.USE_BEST, icon="CHECKMARK")


class AdvancedPanel(ArmaturePanel):
    bl_idname = "HANGTIME_PT_advanced"
    bl_parent_id = SolvePanel.bl_idname
    bl_label = "Advanced"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = split(self)
        settings = settings_in(context)
        layout.prop(settings, "method")
        layout.prop(settings, "keep_times")
        layout.prop(settings, "human_ranges")
        refine = layout.column(heading="Refine")
        refine.prop(settings, "objective")
        refine.prop(settings, "stay_close")
        recipe = layout.column()
        recipe.label(text="Recipe text, for what the lists do not hold:")
        recipe.template_ID(settings, "requests", new="text.new", open="text.open")


class ResultPanel(ArmaturePanel):
    bl_idname = "HANGTIME_PT_result"
    bl_label = "Result"
    bl_order = 7

    def draw(self, context: bpy.types.Context) -> None:
        layout = present(self.layout)
        settings = settings_in(context)
        if settings.adapted is None:
            layout.label(text="Nothing has been adapted yet", icon="INFO")
            return
        accepted = action_settings(settings.adapted).accepted
        layout.label(text=settings.adapted.name, icon="CHECKMARK" if accepted else "ACTION")
        row = layout.row(align=True)
        row.operator(OperatorId.ACCEPT, icon="CHECKMARK")
        row.operator(OperatorId.DISCARD, icon="TRASH")
        row = layout.row(align=True)
        row.operator(OperatorId.COMPARE, icon="ARROW_LEFTRIGHT")
        row.operator(OperatorId.SHOW_REPORT, icon="TEXT")
        lines(layout, settings.status)


class ExportPanel(ArmaturePanel):
    bl_idname = "HANGTIME_PT_export"
    bl_label = "Export"
    bl_order = 8
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, _context: bpy.types.Context) -> None:
        row = present(self.layout).row(align=True)
        row.operator(OperatorId.EXPORT_FBX, text="FBX", icon="EXPORT")
        row.operator(OperatorId.EXPORT_GLTF, text="glTF", icon="EXPORT")
