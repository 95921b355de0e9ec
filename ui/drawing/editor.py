"""Typed reads of the editor that is being drawn: its 3D space, the interface's scale."""

from typing import cast

import bpy

from ...bridge.accessors import present


def view_3d(context: bpy.types.Context) -> bpy.types.SpaceView3D | None:
    """The 3D viewport's space; None in another editor."""
    space = context.space_data
    if space is None or space.type != "VIEW_3D":
        return None
    return cast(bpy.types.SpaceView3D, space)  # its type says so


def ui_scale(context: bpy.types.Context) -> float:
    """The interface's scale, of which 1 is usual."""
    return present(context.preferences).system.ui_scale
