"""The panel of what the viewport and the timeline show."""

from __future__ import annotations

import bpy

from ..operators.names import CATEGORY, PanelId

_CONSTRAINTS = ("pins", "limits", "poses")
_MOTION = ("path", "forces", "momentum")
_CURVES = ("plot_forces", "plot_com", "plot_torque")


class DisplayPanel(bpy.types.Panel):
    bl_idname = PanelId.DISPLAY
    bl_label = "Display"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = CATEGORY
    bl_order = 8
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012

    def draw_header(self, context: bpy.types.Context) -> None:
        self.layout.prop(context.scene.hangtime.view, "show", text="")

    def draw(self, context: bpy.types.Context) -> None:
        layout, view = self.layout, context.scene.hangtime.view
        layout.use_property_split = True
        layout.use_property_decorate = False
        shown = layout.column()
        shown.active = view.show
        _draw_column(shown, view, "Constraints", _CONSTRAINTS)
        _draw_column(shown, view, "Motion", _MOTION)
        _draw_ghosts(shown, view)
        shown.column(heading="Numbers").prop(view, "labels")
        _draw_plots(layout, view)
        layout.column(heading="Timeline").prop(view, "timeline", text="Contacts")


def _draw_column(
    layout: bpy.types.UILayout, view: bpy.types.PropertyGroup, heading: str, names: tuple[str, ...]
) -> None:
    column = layout.column(heading=heading)
    for name in names:
        column.prop(view, name)


def _draw_ghosts(layout: bpy.types.UILayout, view: bpy.types.PropertyGroup) -> None:
    column = layout.column(heading="Ghosts")
    column.prop(view, "ghosts", text="Show")
    column = column.column()
    column.active = view.ghosts
    column.prop(view, "recording_too", text="Recording Too")
    column.prop(view, "ghost_step", text="Every n Frames")


def _draw_plots(layout: bpy.types.UILayout, view: bpy.types.PropertyGroup) -> None:
    column = layout.column(heading="Plots")
    column.prop(view, "plots", text="Show")
    column = column.column()
    column.active = view.plots
    for name in _CURVES:
        column.prop(view, name)
    column.prop(view, "plot_bone")


CLASSES = (DisplayPanel,)
