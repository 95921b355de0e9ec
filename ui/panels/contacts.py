"""Panels of contacts: what touches when and where, and where it shall touch instead."""

import bpy

from ...bridge.accessors import present
from ...bridge.properties.settings import settings_of
from ...bridge.properties.stances import active_contact, active_stance
from ...bridge.rows.phases import listed
from ...operators.names import OperatorId
from ...operators.solve.common import chosen_armature
from .lists import ContactList, StanceList, called
from .sidebar import OF_SOLVES, ArmaturePanel, draw_at_work, draw_list, settings_in, split

NOT_SOUGHT = "Press Analyze to find them"
NONE_FOUND = "Nothing touches in these frames"
BACKWARDS = "Forward is at the body's back"


class ContactsPanel(ArmaturePanel):
    bl_idname = "HANGTIME_PT_contacts"
    bl_label = "Contacts"
    bl_order = 4

    def draw(self, context: bpy.types.Context) -> None:
        layout = present(self.layout)
        settings = settings_in(context)
        if not listed(settings):
            layout.label(text=NONE_FOUND if settings.analysed else NOT_SOUGHT, icon="INFO")
            return
        draw_list(layout, StanceList, settings, "stances", rows=3)
        layout.prop(settings, "moves")


class StancePanel(ArmaturePanel):
    bl_idname = "HANGTIME_PT_stance"
    bl_parent_id = ContactsPanel.bl_idname
    bl_label = ""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        armature = chosen_armature(context)
        return armature is not None and active_stance(settings_of(armature)) is not None

    def draw_header(self, context: bpy.types.Context) -> None:
        settings = settings_in(context)
        name = called(settings, present(active_stance(settings)).name)
        present(self.layout).label(text=f"Move {name}")

    def draw(self, context: bpy.types.Context) -> None:
        layout = split(self)
        stance = present(active_stance(settings_in(context)))
        column = layout.column(align=True)
        for name in ("forward", "left", "up", "turn"):
            column.prop(stance, name)
        if stance.backwards:
            layout.label(text=BACKWARDS, icon="INFO")
        if draw_at_work(layout, *OF_SOLVES):  # letting go of a pin adapts
            return
        buttons = layout.row(align=True)
        buttons.operator(OperatorId.DRAG_PIN, text="Drag", icon="VIEW_PAN")
        buttons.operator(OperatorId.PUT_BACK, icon="LOOP_BACK")


class StanceContactsPanel(ArmaturePanel):
    bl_idname = "HANGTIME_PT_stance_contacts"
    bl_parent_id = ContactsPanel.bl_idname
    bl_label = ""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        armature = chosen_armature(context)
        return armature is not None and bool(listed(settings_of(armature)))

    def draw_header(self, context: bpy.types.Context) -> None:
        settings = settings_in(context)
        stance = active_stance(settings)
        of = f" of {called(settings, stance.name)}" if stance is not None else ""
        present(self.layout).label(text=f"Contacts{of}")

    def draw(self, context: bpy.types.Context) -> None:
        layout = present(self.layout)
        side = draw_list(layout, ContactList, settings_in(context), "contacts", rows=4)
        side.operator(OperatorId.ADD_CONTACT, text="", icon="ADD")
        side.operator(OperatorId.REMOVE_CONTACT, text="", icon="REMOVE")


class ContactPanel(ArmaturePanel):
    bl_idname = "HANGTIME_PT_contact"
    bl_parent_id = StanceContactsPanel.bl_idname
    bl_label = ""
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        armature = chosen_armature(context)
        return armature is not None and active_contact(settings_of(armature)) is not None

    def draw_header(self, context: bpy.types.Context) -> None:
        row = present(active_contact(settings_in(context)))
        present(self.layout).label(text=f"{row.name} ({row.bone})")

    def draw(self, context: bpy.types.Context) -> None:
        layout = split(self)
        row = present(active_contact(settings_in(context)))
        frames = layout.column(align=True)
        frames.prop(row, "start_frame")
        frames.prop(row, "end_frame")
        layout.column(align=True).prop(row, "place")
        layout.prop(row, "on")
        layout.prop(row, "empty")
        layout.operator(OperatorId.PLACE_BY_EMPTY, icon="EMPTY_AXIS")
