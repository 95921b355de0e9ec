"""What the sidebar's panels share."""

from __future__ import annotations

import bpy

from ...operators.names import CATEGORY
from ...operators.solve.common import chosen_armature


class SidebarPanel:
    """Mixin: a panel of the extension's tab. Drawing shows what is stored and computes nothing."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = CATEGORY


class ArmaturePanel(SidebarPanel):
    """Mixin: a panel about the chosen armature."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return chosen_armature(context) is not None


def split(layout: bpy.types.UILayout) -> None:
    """Labels left, values right, as in Blender's own panels."""
    layout.use_property_split = True
    layout.use_property_decorate = False


def lines(layout: bpy.types.UILayout, text: str, icon: str = "NONE") -> None:
    """Several lines of text, close together; the icon stands before the first."""
    column = layout.column(align=True)
    column.scale_y = 0.8
    for line in text.splitlines():
        column.label(text=line, icon=icon)
        icon = "BLANK1" if icon != "NONE" else "NONE"
