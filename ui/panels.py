"""The sidebar's tab in the 3D viewport. Drawing shows what is stored and computes nothing."""

from __future__ import annotations

import bpy

from ..bridge.stances import active_contact, active_stance
from ..operators.common import chosen_armature
from ..operators.names import CATEGORY, ListId, OperatorId, PanelId


class _SidebarPanel:
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = CATEGORY


class CharacterPanel(_SidebarPanel, bpy.types.Panel):
    bl_idname = PanelId.CHARACTER
    bl_label = "Recording"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        armature = chosen_armature(context)
        active = armature.name if armature is not None else ""
        layout.prop(context.scene.hangtime, "armature", placeholder=active)
        if armature is not None:
            _draw_figure(layout, armature.hangtime)
        layout.operator(OperatorId.ANALYZE, icon="VIEWZOOM")


def _draw_figure(layout: bpy.types.UILayout, settings: bpy.types.PropertyGroup) -> None:
    layout.prop(settings, "mass")
    layout.prop(settings, "mass_table")
    if settings.measured_height > 0.0:
        layout.label(text=f"Measured height: {settings.measured_height:.2f} m")
    height = layout.row(heading="Own Height")
    height.prop(settings, "use_height", text="")
    value = height.row()
    value.active = settings.use_height
    value.prop(settings, "height", text="")
    span = layout.row(heading="Frame Range")
    span.prop(settings, "use_range", text="")
    frames = span.row(align=True)
    frames.active = settings.use_range
    frames.prop(settings, "first_frame", text="")
    frames.prop(settings, "last_frame", text="")


class ContactsPanel(_SidebarPanel, bpy.types.Panel):
    bl_idname = PanelId.CONTACTS
    bl_label = "Contacts"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        armature = chosen_armature(context)
        return armature is not None and len(armature.hangtime.contacts) > 0

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        settings = chosen_armature(context).hangtime
        layout.template_list(
            ListId.CONTACTS, "", settings, "contacts", settings, "active_contact", rows=8
        )
        layout.prop(settings, "whole_stance")


class StancePanel(_SidebarPanel, bpy.types.Panel):
    bl_idname = PanelId.STANCE
    bl_parent_id = PanelId.CONTACTS
    bl_label = ""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return active_stance(chosen_armature(context).hangtime) is not None

    def draw_header(self, context: bpy.types.Context) -> None:
        self.layout.label(text=f"Move {active_stance(chosen_armature(context).hangtime).name}")

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        stance = active_stance(chosen_armature(context).hangtime)
        column = layout.column(align=True)
        for name in ("forward", "left", "up", "turn"):
            column.prop(stance, name)
        layout.operator(OperatorId.PUT_BACK, icon="LOOP_BACK")


class ContactPanel(_SidebarPanel, bpy.types.Panel):
    bl_idname = PanelId.CONTACT
    bl_parent_id = PanelId.CONTACTS
    bl_label = ""
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012 - Blender reads a set

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return active_contact(chosen_armature(context).hangtime) is not None

    def draw_header(self, context: bpy.types.Context) -> None:
        row = active_contact(chosen_armature(context).hangtime)
        self.layout.label(text=f"{row.name} ({row.bone})")

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        row = active_contact(chosen_armature(context).hangtime)
        frames = layout.column(align=True)
        frames.prop(row, "start_frame")
        frames.prop(row, "end_frame")
        layout.column(align=True).prop(row, "place")
        layout.prop(row, "empty")
        layout.operator(OperatorId.PLACE_BY_EMPTY, icon="EMPTY_AXIS")


class AdaptPanel(_SidebarPanel, bpy.types.Panel):
    bl_idname = PanelId.ADAPT
    bl_label = "Adapted Motion"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return chosen_armature(context) is not None

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        requests = layout.column()
        requests.label(text="Limits, Poses, Loads, Timing")
        settings = chosen_armature(context).hangtime
        requests.template_ID(settings, "requests", new="text.new", open="text.open")
        adapt = layout.row()
        adapt.scale_y = 1.5
        adapt.operator(OperatorId.ADAPT, icon="PLAY")
        takes = layout.row(align=True)
        takes.operator(OperatorId.SHOW_RECORDING)
        takes.operator(OperatorId.SHOW_ADAPTED)
        for line in chosen_armature(context).hangtime.status.splitlines():
            layout.label(text=line)


CLASSES = (CharacterPanel, ContactsPanel, StancePanel, ContactPanel, AdaptPanel)
