"""The panel of what the viewport and the timeline show."""

import bpy

from ...bridge.accessors import armature_data, present
from ...bridge.properties.settings import scene_settings
from ...bridge.properties.view import HangtimeView
from ...operators.names import OperatorId
from ...operators.solve.common import chosen_armature
from .sidebar import ArmaturePanel, split

_COLUMNS = {
    "Constraints": ("pins", "limits", "all_limits", "poses"),
    "Motion": ("path", "forces", "momentum", "changes", "shapes", "faults"),
}
_CURVES = ("plot_forces", "plot_com", "plot_torque")


class DisplayPanel(ArmaturePanel):
    bl_idname = "HANGTIME_PT_display"
    bl_label = "Display"
    bl_order = 9
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context: bpy.types.Context) -> None:
        present(self.layout).prop(scene_settings(context.scene).view, "show", text="")

    def draw(self, context: bpy.types.Context) -> None:
        layout, view = split(self), scene_settings(context.scene).view
        shown = layout.column()
        shown.active = view.show
        for heading, names in _COLUMNS.items():
            column = shown.column(heading=heading)
            for name in names:
                column.prop(view, name)
        _draw_ghosts(shown, view)
        shown.column(heading="Numbers").prop(view, "labels")
        _draw_plots(shown, context)
        layout.column(heading="Timeline").prop(view, "timeline", text="Contacts")


def _draw_ghosts(layout: bpy.types.UILayout, view: HangtimeView) -> None:
    column = layout.column(heading="Ghosts")
    column.prop(view, "ghosts", text="Show")
    column = column.column()
    column.active = view.ghosts
    column.prop(view, "recording_too", text="Recording Too")
    column.prop(view, "ghost_auto")
    step = column.column()
    step.active = not view.ghost_auto
    step.prop(view, "ghost_step", text="Frame Step")


def _draw_plots(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    view = scene_settings(context.scene).view
    column = layout.column(heading="Plots")
    column.prop(view, "plots", text="Show")
    column = column.column()
    column.active = view.plots
    for name in _CURVES:
        column.prop(view, name)
    armature = chosen_armature(context)
    if armature is None:
        column.prop(view, "plot_bone")
    else:
        column.prop_search(view, "plot_bone", armature_data(armature), "bones")
    layout.operator(OperatorId.SAVE_PLOTS, icon="EXPORT")
