"""Solve, Result and Export."""

import bpy

from ...bridge.accessors import current_action, present
from ...bridge.properties.action import action_settings
from ...bridge.properties.settings import settings_of
from ...bridge.results.start import starts_from_result
from ...bridge.rows.choices import After
from ...bridge.rows.kind import Icon
from ...bridge.takes.takes import ListedTake, takes_of
from ...operators.names import OperatorId
from ...operators.solve.common import chosen_armature
from ...operators.solve.results import compared, performer_of, result_of
from ...operators.solve.session import session
from ..drawing.wrapping import wrapped
from .failure import draw_failure
from .sidebar import OF_SOLVES, ArmaturePanel, draw_grey, lines, optional, settings_in, split


class SolvePanel(ArmaturePanel):
    bl_idname = "HANGTIME_PT_solve"
    bl_label = "Solve"
    bl_order = 2  # above the lists, which grow

    def draw(self, context: bpy.types.Context) -> None:
        layout = present(self.layout)
        self._draw_start(layout, context)
        row = layout.row(align=True)
        row.scale_y = 1.5
        solving = session().solving
        if solving is not None and solving.of in OF_SOLVES:
            draw_grey(row, solving.doing.capitalize())
            layout.progress(factor=solving.share, text=f"{100.0 * solving.share:.0f} %")
            row = layout.row(align=True)
            row.operator(OperatorId.USE_BEST, icon="CHECKMARK")
            row.operator(OperatorId.CANCEL, icon="X")
            return
        row.operator(OperatorId.ADAPT, icon="PLAY")
        row.operator(OperatorId.REFINE, icon="SMOOTHCURVE")
        armature = present(chosen_armature(context))
        draw_failure(layout, context, armature, *OF_SOLVES)
        if session().best_of(armature) is not None:
            layout.operator(OperatorId.USE_BEST, icon="CHECKMARK")

    @staticmethod
    def _draw_start(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
        """From what the next result is made, once there is a result."""
        armature = present(chosen_armature(context))
        if len(takes_of(armature)) < 2:
            return
        on_result = starts_from_result(armature)
        line = layout.split(factor=0.3)
        line.label(text="Start From")
        row = line.row(align=True)
        for text, result in (("Recording", False), ("This Result", True)):
            start = row.operator(OperatorId.START_FROM, text=text, depress=result is on_result)
            start.result = result


class AdvancedPanel(ArmaturePanel):
    bl_idname = "HANGTIME_PT_advanced"
    bl_parent_id = SolvePanel.bl_idname
    bl_label = "Advanced"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = split(self)
        settings = settings_in(context)
        layout.operator(OperatorId.FIT, icon="CON_FOLLOWPATH")
        if settings.fit_quality:
            lines(layout, wrapped(context, settings.fit_quality), icon="CHECKMARK")
        layout.prop(settings, "good_enough")
        layout.prop(settings, "method")
        layout.prop(settings, "keep_times")
        layout.prop(settings, "human_ranges")
        ranges = layout.column()
        ranges.active = settings.human_ranges
        ranges.prop(settings, "hard_ranges")
        ranges.prop(settings, "wider_ranges")
        refine = layout.column(heading="Refine")
        refine.prop(settings, "objective")
        refine.prop(settings, "stay_close")
        recipe = layout.column()
        recipe.label(text="Recipe text, for what the lists do not hold:")
        recipe.template_ID(settings, "requests", new="text.new", open="text.open")


class TakePanel(ArmaturePanel):
    bl_idname = "HANGTIME_PT_take"
    bl_parent_id = SolvePanel.bl_idname
    bl_label = "Rest of the Take"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = split(self)
        options = settings_in(context).result
        layout.active = not settings_in(context).loop.use  # a loop is an action of its own
        layout.prop(options, "after")
        if options.after == After.RETURN.name:
            optional(layout, options, "use_return_frame", "By Frame", "return_frame")
        column = layout.column()
        column.active = options.after != After.CUT.name
        optional(column, options, "use_blend", "Custom Blend", "blend_in", "blend_out")
        column.prop(options, "lock_others")
        layout.prop(options, "written_as")
        layout.prop(options, "keep_polish")
        layout.prop(options, "markers")
        layout.prop(options, "contact_channels")


class ResultPanel(ArmaturePanel):
    bl_idname = "HANGTIME_PT_result"
    bl_label = "Result"
    bl_order = 3

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        armature = chosen_armature(context)
        if armature is None:
            return False
        return settings_of(armature).adapted is not None or len(takes_of(armature)) > 1

    def draw(self, context: bpy.types.Context) -> None:
        layout = present(self.layout)
        armature = present(chosen_armature(context))
        settings = settings_of(armature)
        self._draw_takes(layout, context, takes_of(armature))
        row = layout.row(align=True)
        row.operator(OperatorId.ACCEPT, icon="CHECKMARK")
        row.operator(OperatorId.DISCARD, icon="TRASH")
        row = layout.row(align=True)
        self._draw_switch(row, armature)
        row.operator(OperatorId.SHOW_REPORT, text="Report", icon="TEXT")
        warning = shown_warning(armature)
        if warning:
            box = layout.box()
            box.alert = True
            lines(box, wrapped(context, warning), icon="ERROR")
        told = layout.column()
        told.active = current_action(armature) == settings.adapted
        for first in beside_warning(armature)[:1]:
            lines(told, wrapped(context, first, icons=0))

    @staticmethod
    def _draw_switch(row: bpy.types.UILayout, armature: bpy.types.Object) -> None:
        """Recording or result, whichever is shown pressed."""
        for text, action in zip(("Recording", "Result"), compared(armature) or (), strict=False):
            pressed = current_action(armature) == action
            show = row.operator(OperatorId.SHOW_TAKE, text=text, depress=pressed)
            show.action, show.switch = action.name_full, True

    @staticmethod
    def _draw_takes(
        layout: bpy.types.UILayout, context: bpy.types.Context, takes: tuple[ListedTake, ...]
    ) -> None:
        """A line a take, of which the shown one is marked; why a result is not up to date."""
        column = layout.box().column(align=True)
        for take in takes:
            row = column.row(align=True)
            icon: Icon = "RADIOBUT_ON" if take.shown else "RADIOBUT_OFF"
            show = row.operator(OperatorId.SHOW_TAKE, text="", icon=icon, emboss=False)
            show.action = take.action.name_full
            for _ in range(take.depth - 1):
                row.label(text="", icon="BLANK1")
            name = row.row(align=True)
            name.enabled = take.action.is_editable
            name.prop(action_settings(take.action), "called", text="", emboss=False)
            end = row.row(align=True)
            end.alignment = "RIGHT"
            if take.source is None:
                end.label(text="Recording")
            if take.polished:
                end.label(text="", icon="GREASEPENCIL")
            if action_settings(take.action).warning:
                end.label(text="", icon="ERROR")
            if take.stale:
                end.label(text="", icon="FILE_REFRESH")
            if action_settings(take.action).accepted:
                end.label(text="", icon="CHECKMARK")
        for take in takes:
            if take.shown and take.stale:
                lines(column, wrapped(context, take.stale), icon="FILE_REFRESH")
                column.operator(OperatorId.UPDATE)


def shown_warning(armature: bpy.types.Object) -> str:
    """What is beyond reason in the result that is shown."""
    result = result_of(armature)
    if result is None or current_action(performer_of(armature)) != result:
        return ""
    return str(action_settings(result).warning)


def beside_warning(armature: bpy.types.Object) -> list[str]:
    """The lines on the last result, but for those that its warning says above them."""
    warned = shown_warning(armature).splitlines()
    return [line for line in settings_of(armature).status.splitlines() if line not in warned]


class DetailsPanel(ArmaturePanel):
    bl_idname = "HANGTIME_PT_details"
    bl_parent_id = ResultPanel.bl_idname
    bl_label = "Details"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        armature = chosen_armature(context)
        return armature is not None and len(beside_warning(armature)) > 1

    def draw(self, context: bpy.types.Context) -> None:
        armature = present(chosen_armature(context))
        settings = settings_of(armature)
        told = present(self.layout).column()
        told.active = current_action(armature) == settings.adapted
        for line in beside_warning(armature)[1:]:
            lines(told, wrapped(context, line, icons=0))
            told.separator(factor=0.5)


class ExportPanel(ArmaturePanel):
    bl_idname = "HANGTIME_PT_export"
    bl_label = "Export"
    bl_order = 8
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, _context: bpy.types.Context) -> None:
        row = present(self.layout).row(align=True)
        row.operator(OperatorId.EXPORT, text="Export…", icon="EXPORT")
        row.operator(OperatorId.EXPORT_RECIPE, text="Recipe", icon="TEXT")
