"""The list of contacts."""

from __future__ import annotations

import bpy

from .names import ListId


class ContactList(bpy.types.UIList):
    bl_idname = ListId.CONTACTS

    def draw_item(
        self,
        _context: bpy.types.Context,
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
        names = line.split(factor=0.36, align=True)
        names.label(text=row.name)
        names = names.split(factor=0.38, align=True)
        names.label(text=row.phase)
        frames = names.row(align=True)
        frames.prop(row, "start_frame", text="", emboss=False)
        frames.prop(row, "end_frame", text="", emboss=False)


CLASSES = (ContactList,)
