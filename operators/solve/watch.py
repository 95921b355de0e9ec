"""Looks whether results are up to date, some moments after something changed.

That takes digests of the keys of all takes. They are found in parts, and kept as long as Blender
tells of no change of any action, not even of one that nothing performs; it tells of new curves as
of a change of the scene.
"""

import bpy
from bpy.app.handlers import persistent

from ...bridge.accessors import current_action
from ...bridge.armature.poses import frames_per_second, metres_per_unit
from ...bridge.repairs.stored import examined_actions, look_at_examination
from ...bridge.results.look_again import look_again, looked_at
from .common import chosen_armature
from .live import editors
from .session import session

DELAY = 0.4  # s after the first change; keys that are dragged change with every move of the mouse


@persistent  # type: ignore[untyped-decorator]  # any, in the stubs
def follow_takes(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    """Notes that an action, an armature, or the scene's clock or unit changed."""
    if depsgraph.id_type_updated("ACTION") or depsgraph.id_type_updated("SCENE"):
        forget_digests()
    ids = (update.id for update in depsgraph.updates)
    before, session().units = session().units, (frames_per_second(scene), metres_per_unit(scene))
    moved = any(isinstance(each, bpy.types.Action | bpy.types.Object) for each in ids)
    if moved or session().units != before:
        look_soon()


@persistent  # type: ignore[untyped-decorator]  # any, in the stubs
def forget_digests(*_of_handlers: object) -> None:
    """Keys may be others: something changed them, or was undone; or the scene went to another
    frame, after which Blender does not tell of what changed before. A look that is in the middle of
    them waits, for there may be more to come."""
    if session().digests.forget() and bpy.app.timers.is_registered(look):
        forget()
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
    digests = session().digests
    if not digests.find([*looked_at(armature), *examined_actions(armature)]):
        return 0.0
    if any([look_again(armature, digests), look_at_examination(armature, digests)]):
        for area in editors("VIEW_3D"):
            area.tag_redraw()
    return None
