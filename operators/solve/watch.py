"""Looks whether results are up to date, some moments after something changed."""

import bpy
from bpy.app.handlers import persistent

from ...bridge.accessors import current_action
from ...bridge.armature.poses import frames_per_second, metres_per_unit
from ...bridge.repairs.stored import look_at_examination
from ...bridge.results.look_again import look_again
from .common import chosen_armature
from .live import editors
from .session import session

DELAY = 0.4  # s after the first change; keys that are dragged change with every move of the mouse


@persistent  # type: ignore[untyped-decorator]  # any, in the stubs
def follow_takes(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    """Notes that an action, an armature, or the scene's clock or unit changed."""
    ids = (update.id for update in depsgraph.updates)
    before, session().units = session().units, (frames_per_second(scene), metres_per_unit(scene))
    moved = any(isinstance(each, bpy.types.Action | bpy.types.Object) for each in ids)
    if moved or session().units != before:
        look_soon()


def look_soon() -> None:
    """Looks some moments from now, where there is somebody to see it."""
    if not (bpy.app.background or bpy.app.timers.is_registered(look)):
        bpy.app.timers.register(look, first_interval=DELAY)


def forget() -> None:
    """Takes back a look that is still to come."""
    if bpy.app.timers.is_registered(look):
        bpy.app.timers.unregister(look)


def look() -> float | None:
    """Timer: marks results that are out of date; waits for what is under way."""
    if session().running:  # what it writes changes which results are up to date
        return DELAY
    armature = chosen_armature(bpy.context)
    if armature is None or current_action(armature) is None:
        return None
    if any([look_again(armature), look_at_examination(armature)]):
        for area in editors("VIEW_3D"):
            area.tag_redraw()
    return None
