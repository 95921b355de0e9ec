"""The lists of contacts, constraints, body changes and surfaces, and what their kinds look like."""

import bpy

from ...bridge.accessors import current_action, present
from ...bridge.constraint_kinds import KINDS
from ...bridge.properties.action import action_settings
from ...bridge.properties.contact import HangtimeContact, HangtimeStance
from ...bridge.properties.overridden_lists import linked_count
from ...bridge.properties.settings import HangtimeSettings, settings_of
from ...bridge.properties.stances import active_stance, stance_contacts, stance_frames
from ...bridge.properties.surface import HangtimeSurface
from ...bridge.rows.choices import BodyKind, Met, SurfaceRole
from ...bridge.rows.kind import Icon, Row
from ...bridge.rows.phases import TAKE_OFF, roles
from ...solver.data.contacts import phase_title
from ..drawing.editor import ui_scale

WIDE = 340  # px; a sidebar in which the range finds room beside the name
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


def status_counts(armature: bpy.types.Object) -> bool:
    """Whether what rows say of the last solve is about what is shown, and what is asked now."""
    result: bpy.types.Action | None = settings_of(armature).adapted
    shown = result is not None and current_action(armature) == result
    beside = result is not None and action_settings(result).performer not in (None, armature)
    return result is not None and (shown or beside) and not action_settings(result).stale


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
            end.active = status_counts(row.id_data)
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
        _context: bpy.types.Context,
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
        line.label(text=row.name)
        _draw_frames(line, (row.start_frame, row.end_frame))

    # The stubs want arrays of Blender's, which nobody can make.
    def filter_items(  # type: ignore[override]
        self, _context: bpy.types.Context, settings: HangtimeSettings, name: str
    ) -> tuple[list[int], list[int]]:
        """Only the contacts of the stance that is chosen, and those of none."""
        stance = active_stance(settings)
        shown = None if stance is None else stance.name
        named = {row.name for row in settings.stances}
        rows = getattr(settings, name)
        kept = [not row.surplus and (row.phase == shown or row.phase not in named) for row in rows]
        return [self.bitflag_filter_item if keep else 0 for keep in kept], []


class StanceList(bpy.types.UIList):
    bl_idname = "HANGTIME_UL_stances"

    def draw_item(
        self,
        _context: bpy.types.Context,
        layout: bpy.types.UILayout,
        settings: HangtimeSettings | None,
        stance: HangtimeStance | None,
        _icon: int | None,
        _active_owner: HangtimeSettings | None,
        _active_name: str | None,
        _index: int | None,
        _filter: int | None,
    ) -> None:
        row, owner = present(stance), present(settings)
        line = layout.row(align=True)
        frames = stance_frames(owner, row.name)
        line.active = frames is not None
        role = called(owner, row.name)
        line.label(text=role, icon="TRIA_UP_BAR" if role == TAKE_OFF else "TRIA_DOWN_BAR")
        if frames is not None:
            _draw_frames(line, frames)

    def filter_items(  # type: ignore[override]
        self, _context: bpy.types.Context, settings: HangtimeSettings, name: str
    ) -> tuple[list[int], list[int]]:
        """Only stances with contacts: an override cannot drop what its library alone found."""
        rows = getattr(settings, name)
        kept = [bool(stance_contacts(settings, row.name)) for row in rows]
        return [self.bitflag_filter_item if keep else 0 for keep in kept], []


def called(settings: HangtimeSettings, phase: str) -> str:
    """What a stance is called to the artist: by its role, where phases still have it."""
    return roles(settings).get(phase, phase_title(phase))


def _draw_frames(line: bpy.types.UILayout, frames: tuple[float, float]) -> None:
    """At the end of a line, as wide as they need."""
    end = line.row()
    end.alignment = "RIGHT"
    end.label(text=f"{frames[0]:.0f}–{frames[1]:.0f}")
