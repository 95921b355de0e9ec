"""The scene's surfaces before, during and after a solve: reading, staleness, and what is said."""

import bpy

from ...bridge.accessors import current_scene
from ...bridge.armature.actions import showing_recorded
from ...bridge.armature.incremental import Incremental
from ...bridge.constraints.surface_status import write_surface_status
from ...bridge.properties.settings import settings_of
from ...bridge.scene.members import is_gone, members
from ...bridge.scene.read import SceneReading, changed_objects, read_scene
from ...bridge.scene.skin import SkinReading, read_skin
from ...solver.arrays import FloatArray
from ...solver.data.faults import SceneFault
from ...solver.data.reports.report import Report
from ...solver.data.solver_options import ShapeSource
from .session import Asked

RESHAPED = "{} changes its shape; what counts is that of frame {:.0f}"
STALE = "{} changed while this was solved; press Adapt again"
GONE = "{} was deleted while this was solved; remove its row, or undo, and press Adapt again"


def read_surfaces(armature: bpy.types.Object, frames: FloatArray) -> Incremental[SceneReading]:
    """The armature's surfaces at frames (T,). Raises ObjectGone, NoFaces, TooManyFaces."""
    solid = members(settings_of(armature), current_scene())
    return (yield from read_scene(solid, frames, showing_recorded(armature)))


def read_bound(armature: bpy.types.Object, frames: FloatArray) -> Incremental[SkinReading]:
    """What of a mesh tells the body's shapes; nothing where these are to be from the bones."""
    if ShapeSource[settings_of(armature).shapes] is ShapeSource.BONES:
        return SkinReading()
    return (yield from read_skin(armature, frames, showing_recorded(armature)))


def stale_surfaces(asked: Asked, armature: bpy.types.Object) -> Incremental[tuple[str, ...]]:
    """Names of the surfaces that are no longer what was sent to be solved."""
    if not asked.scene.objects:
        return ()
    try:
        now = yield from read_surfaces(armature, asked.recording.frames)
    except SceneFault as fault:
        return (fault.thing,)
    return changed_objects(asked.scene, now)


def note_surfaces(
    armature: bpy.types.Object, asked: Asked, report: Report, stale: tuple[str, ...]
) -> list[str]:
    """Writes the rows' outcomes; returns lines for the sidebar."""
    settings = settings_of(armature)
    gone = {row.called for row in settings.surfaces if is_gone(row, current_scene())}
    lines = {name: (GONE if name in gone else STALE).format(name) for name in stale}
    first = float(asked.recording.frames[0])
    for name in asked.scene.reshaped:
        lines.setdefault(name, RESHAPED.format(name, first))
    write_surface_status(settings, report, lines, stale, asked.scene.objects)
    return list(lines.values())
