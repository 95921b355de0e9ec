"""Every name under which Blender knows a part of the extension."""

from enum import StrEnum

CATEGORY = "Hangtime"  # the sidebar's tab
COMMAND = "hangtime"  # blender --command hangtime
ATTRIBUTE = "hangtime"  # what Scene, Object and Action carry


class OperatorId(StrEnum):
    """bl_idname of each operator; also bpy.ops.<name>."""

    ANALYZE = "hangtime.analyze"
    ADAPT = "hangtime.adapt"
    PLACE_BY_EMPTY = "hangtime.place_by_empty"
    PUT_BACK = "hangtime.put_back"
    SHOW_RECORDING = "hangtime.show_recording"
    SHOW_ADAPTED = "hangtime.show_adapted"


class PanelId(StrEnum):
    """bl_idname of each panel of the sidebar, from top to bottom."""

    CHARACTER = "HANGTIME_PT_character"
    CONTACTS = "HANGTIME_PT_contacts"
    STANCE = "HANGTIME_PT_stance"
    CONTACT = "HANGTIME_PT_contact"
    ADAPT = "HANGTIME_PT_adapt"


class ListId(StrEnum):
    """bl_idname of each list."""

    CONTACTS = "HANGTIME_UL_contacts"
