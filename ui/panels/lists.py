"""The lists of contacts, constraints, body changes and surfaces, and what their kinds look like."""

import bpy

from ...bridge.accessors import present
from ...bridge.constraint_kinds import KINDS
from ...bridge.constraints.linked_rows import linked_count
from ...bridge.properties.settings import HangtimeContact, HangtimeSettings
from ...bridge.properties.surface import HangtimeSurface
from ...bridge.rows.choices import BodyKind, Met, SurfaceRole
from ...bridge.rows.kind import Icon, Row
from ..drawing.editor import ui_scale

WIDE = 340  # px; a sidebar in which the range finds room beside the name
CONTACT_WIDE = 400  # px; one in which the places find room too
ICONS: dict[str, Icon] = {
    **{kind.name: kind.icon for kind in KINDS.values()},
    BodyKind.LOAD.name: "PACKAGE",
    BodyKind.LIMB.name: "BONE_DATA",
    BodyKind.SHAPE.name: "MESH_CAPSULE",
}
MET_ICONS: dict[str, Icon] = {
    Met.UNKNOWN.name: "INFO",
    Met.MET.name: "CHECKMARK",
    Met.MISSED.name: "ERROR",
}


ROLE_ICONS: dict[str, Icon] = {
    SurfaceRole.GROUND.name: "SNAP_FACE",
    SurfaceRole.OBSTACLE.name: "CUBE",
    SurfaceRole.CLEAR.name: "TRIA_UP_BAR",
}


class _RowList(bpy.types.UIList):
    """Base: a line of either list."""

    rows = ""  # the settings' property

    def draw_item(
        self,
        context: bpy.types.Context,
        layout: bpy.types.UILayout,
        _settings: HangtimeSettings | None,
        row: Row,
        _icon: int | None,
        _active_owner: HangtimeSettings | None,
        _active_name: str | None,
        index: int | None,
        _filter: int | None,
    ) -> None:
        line = layout.row(align=True)
        line.prop(row, "used", text="")
        line = line.row(align=True)
        line.active = row.used
        wide = present(context.region).width > WIDE * ui_scale(context)
        text = self.told(row) if wide else ""
        if text:
            line = line.split(factor=0.65, align=True)
        name = line.row(align=True)
        if present(index) < linked_count(row.id_data, self.rows):
            name.label(text=row.name, icon=ICONS[row.kind])
        else:
            name.prop(row, "name", text="", emboss=False, icon=ICONS[row.kind])
        end = line.row(align=True)
        end.alignment = "RIGHT"
        if text:
            end.label(text=text)
        if row.status:
            end.label(text="", icon=MET_ICONS[row.met])

    def told(self, row: Row) -> str:
        """What stands beside the name."""
        raise NotImplementedError


class ConstraintList(_RowList):
    bl_idname = "HANGTIME_UL_constraints"
    rows = "constraints"

    def told(self, row: Row) -> str:
        return KINDS[row.kind].told(row)


class BodyChangeList(_RowList):
    bl_idname = "HANGTIME_UL_body_changes"
    rows = "body_changes"

    def told(self, row: Row) -> str:
        if row.kind == BodyKind.LIMB.name:
            return f"× {row.length:.2g}" if row.length != 1.0 else ""
        if row.kind == BodyKind.SHAPE.name:
            return f"× {row.thickness:.2g}" if row.thickness != 1.0 else ""
        return f"{100.0 * row.share:.0f} %" if row.by_share else f"{row.mass:.3g} kg"


class SurfaceList(bpy.types.UIList):
    bl_idname = "HANGTIME_UL_surfaces"

    def draw_item(
        self,
        _context: bpy.types.Context,
        layout: bpy.types.UILayout,
        _settings: HangtimeSettings | None,
        surface: HangtimeSurface | None,
        _icon: int | None,
        _active_owner: HangtimeSettings | None,
        _active_name: str | None,
        _index: int | None,
        _filter: int | None,
    ) -> None:
        row = present(surface)
        line = layout.row(align=True)
        line.prop(row, "used", text="")
        line = line.row(align=True)
        line.active = row.used
        line.label(text=row.called, icon=ROLE_ICONS[row.role])
        if row.status:
            line.label(text="", icon=MET_ICONS[row.met])


class ContactList(bpy.types.UIList):
    bl_idname = "HANGTIME_UL_contacts"

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
        wide = present(context.region).width > CONTACT_WIDE * ui_scale(context)
        line = line.split(factor=0.4 if wide else 0.6, align=True)
        line.label(text=row.name)
        if wide:
            line.label(text=row.phase)
        line.label(text=f"{row.start_frame:.0f} – {row.end_frame:.0f}")
