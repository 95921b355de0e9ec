"""The list of contacts."""

from __future__ import annotations

import bpy

from ...operators.names import ListId

WIDE = 400  # px; a sidebar in which the places find room too


class ContactList(bpy.types.UIList):
    bl_idname = ListId.CONTACTS

    def draw_item(
        self,
        context: bpy.types.Context,
        layout: bpy.types.UILayout,
        _settings: bpy.types.PropertyGroup,
        row: bpy.types.PropertyGroup,
        _icon: int,
        _active_owner: bpy.types.PropertyGroup,
        _active_name: str,
    ) -> None:
        line = layout.row(align=True)
        line.prop(row, "used", text="")
        line = line.row(align=True)
        line.active = row.used
        wide = context.region.width > WIDE * context.preferences.system.ui_scale
        line = line.split(factor=0.4 if wide else 0.6, align=True)
        line.label(text=row.name)
        if wide:
            line.label(text=row.phase)
        line.label(text=f"{row.start_frame:.0f} – {row.end_frame:.0f}")


CLASSES = (ContactList,)
