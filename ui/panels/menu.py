"""The menu *Hangtime* in the 3D viewport's Object and Pose menus: F3 finds what is in a menu."""

from contextlib import ExitStack

import bpy

from ...bridge.accessors import present
from ...operators.names import OperatorId

GROUPS = (
    (OperatorId.FIND_BONES, OperatorId.ANALYZE, OperatorId.FIT),
    (OperatorId.ADD_CONTACT, OperatorId.DRAG_PIN, OperatorId.PLACE_BY_EMPTY, OperatorId.PUT_BACK),
    (OperatorId.ADAPT, OperatorId.REFINE, OperatorId.USE_BEST, OperatorId.CANCEL),
    (
        OperatorId.COMPARE,
        OperatorId.SHOW_RECORDING,
        OperatorId.SHOW_ADAPTED,
        OperatorId.ACCEPT,
        OperatorId.DISCARD,
        OperatorId.SHOW_REPORT,
    ),
    (OperatorId.EXPORT_FBX, OperatorId.EXPORT_GLTF, OperatorId.SAVE_PLOTS),
)


class HangtimeMenu(bpy.types.Menu):
    bl_idname = "HANGTIME_MT_hangtime"
    bl_label = "Hangtime"

    def draw(self, _context: bpy.types.Context) -> None:
        layout = present(self.layout)
        for group in GROUPS:
            for operator in group:
                layout.operator(operator)
            layout.separator()


def add(undo: ExitStack) -> None:
    """Appends the menu, until `undo` is closed."""
    for menu in (bpy.types.VIEW3D_MT_object, bpy.types.VIEW3D_MT_pose):
        menu.append(_draw)
        undo.callback(menu.remove, _draw)


def _draw(menu: bpy.types.Menu, _context: bpy.types.Context) -> None:
    layout = present(menu.layout)
    layout.separator()
    layout.menu(HangtimeMenu.bl_idname)
