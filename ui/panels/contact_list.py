"""The list of contacts."""

from __future__ import annotations

import bpy

from ...bridge.accessors import present
from ...bridge.properties.settings import HangtimeContact, HangtimeSettings
from ...operators.names import ListId
from ..drawing.editor import ui_scale

WIDE = 400  # px; a sidebar in which the places find room too


class ContactList(bpy.types.UIList):
    bl_idname = ListId.CONTACTS

    def draw_item(
        self,
        context: bpy.types.Context,
        layout: bpy.types.UILayout,
        _settings: HangtimeSettings | None,
        contact: HangtimeContact | None,
        _icon: int | None,
        _active_owner: HangtimeSettings | None,
        _active_name: str | None,
        _index: int | None,
        _filter: int | None,
    ) -> None:
        row = present(contact)
        line = layout.row(align=True)
        line.prop(row, "used", text="")
        line = line.row(align=True)
        line.active = row.used
        wide = present(context.region).width > WIDE * ui_scale(context)
        line = line.split(factor=0.4 if wide else 0.6, align=True)
        line.label(text=row.name)
        if wide:
            line.label(text=row.phase)
        line.label(text=f"{row.start_frame:.0f} – {row.end_frame:.0f}")
