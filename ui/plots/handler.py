"""Draw handler of the plots: looks up what is stored, paints what has been prepared."""

from contextlib import ExitStack

import bpy

from ...bridge.accessors import present
from ...bridge.plots.charts import PlottedMotions, plotted
from ...bridge.plots.screen import Rect
from ...bridge.properties.settings import scene_settings
from ...operators.solve.common import chosen_armature
from ..drawing import paint
from ..drawing.cache import ContentCache
from ..drawing.editor import ui_scale, view_3d
from . import looks
from .drawing import playhead, readings, still
from .figure import PlotFigure, lay_out
from .layout import cards, free_room


def add(undo: ExitStack) -> None:
    """Shows plots in 3D viewports until `undo` is closed."""
    overlay = PlotOverlay()
    space = bpy.types.SpaceView3D
    handle = space.draw_handler_add(overlay.draw, (), "WINDOW", "POST_PIXEL")
    undo.callback(space.draw_handler_remove, handle, "WINDOW")


class PlotOverlay:
    """Draws the plots; what it prepares is remembered for each content and room."""

    def __init__(self) -> None:
        self._drawings = ContentCache[paint.DrawingBatches](paint.CACHED_DRAWINGS)
        self._figures = ContentCache[PlotFigure | None](paint.CACHED_DRAWINGS)

    def draw(self) -> None:
        """Called by Blender for each viewport, and at each frame of playback."""
        context = bpy.context
        shown = _wanted(context)
        if shown is None:
            return
        region, scale = present(context.region), ui_scale(context)
        room = _room(context)
        key = (shown.content, room, scale)
        placed = self._figures.get("figure", key, lambda: arranged(shown, room, scale))
        if placed is None:
            return
        stroke, width = looks.STROKE * scale, paint.text_width
        curves = self._drawings.get("curves", key, lambda: paint.upload(still(placed, width)))
        paint.paint(curves, region, stroke)
        frame = present(context.scene).frame_current_final
        shift = placed.playhead(frame)
        if shift is not None:
            line = self._drawings.get("playhead", key, lambda: paint.upload(playhead(placed)))
            paint.paint(line, region, stroke, shift)
        paint.write(readings(placed, frame))


def arranged(shown: PlottedMotions, room: Rect, scale: float) -> PlotFigure | None:
    """The charts in a free room; None where that is too small or nothing is to be shown."""
    charts = shown.charts()
    places = cards(room, len(charts), scale)
    return lay_out(charts, shown.content.phases, places, scale, paint.text_width)


def _wanted(context: bpy.types.Context) -> PlottedMotions | None:
    view, space = scene_settings(context.scene).view, view_3d(context)
    if space is None or not (view.show and view.plots and space.overlay.show_overlays):
        return None
    armature = chosen_armature(context)
    return plotted(armature, view) if armature is not None else None


def _room(context: bpy.types.Context) -> Rect:
    """The rectangle that bars and the sidebar leave of the viewport, in its px."""
    window = present(context.region)
    overlaps = []
    for region in present(context.area).regions:
        if region.type != "WINDOW" and _is_open(region, view_3d(context)):
            x, y = region.x - window.x, region.y - window.y
            rect = Rect(x, y, x + region.width, y + region.height)
            overlaps.append((str(region.alignment), rect))
    return free_room(window.width, window.height, overlaps)


def _is_open(region: bpy.types.Region, space: bpy.types.SpaceView3D | None) -> bool:
    """Whether a region is to be seen; the shelf's bar keeps its size when the shelf is closed."""
    closed = region.type == "ASSET_SHELF_HEADER" and not (
        space is not None and space.show_region_asset_shelf
    )
    return region.width > 1 and region.height > 1 and not closed
