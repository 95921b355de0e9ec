"""Keys of the result."""

import bpy

from ...bridge.rows.choices import KeyChoice
from .sidebar import ArmaturePanel, settings_in, split
from .solve import SolvePanel


class KeysPanel(ArmaturePanel):
    bl_idname = "HANGTIME_PT_keys"
    bl_parent_id = SolvePanel.bl_idname
    bl_label = "Keys"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = split(self)
        keys = settings_in(context).result_keys
        layout.prop(keys, "on")
        error = layout.column(align=True)
        error.active = keys.on == KeyChoice.REDUCED.name
        error.prop(keys, "distance")
        error.prop(keys, "angle")
