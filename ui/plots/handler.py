"""The plots' draw handler: it looks up what is stored and paints what has been prepared."""

from __future__ import annotations

from collections.abc import Hashable
from contextlib import ExitStack

import bpy

from ...bridge.plots.charts import Plotted, plotted
from ...bridge.plots.screen import Rect
from ...operators.solve.common import chosen_armature
from ..drawing import paint
from . import looks
from .drawing import playhead, readings, still
from .figure import Figure, figure
from .layout import Overlap, cards, free_room


def add(undo: ExitStack) -> None:
    """Shows plots in 3D viewports until `undo` is closed."""
    overlay = PlotOverlay()
    space = bpy.types.SpaceView3D
    handle = space.draw_handler_add(overlay.draw, (), "WINDOW", "POST_PIXEL")
    undo.callback(space.draw_handler_remove, handle, "WINDOW")


class PlotOverlay:
    """Draws the plots; what it prepares is remembered for each content and room."""

    def __init__(self) -> None:
        self._easel = paint.Easel()
        self._figures: dict[Hashable, Figure | None] = {}

    def draw(self) -> None:
        """Called by Blender for each viewport, and at each frame of playback."""
        context = bpy.context
        shown = _wanted(context)
        if shown is None:
            return
        scale = context.preferences.system.ui_scale
        room = _room(context)
        key = (shown.asked, room, scale)
        placed = self._figure(key, shown, room, scale)
        if placed is None:
            return
        stroke = looks.STROKE * scale
        width = paint.text_width
        picture = self._easel.painting(key, lambda: still(placed, width))
        paint.paint(picture, context.region, stroke)
        frame = context.scene.frame_current_final
        shift = placed.playhead(frame)
        if shift is not None:
            line = self._easel.painting((key, "playhead"), lambda: playhead(placed))
            paint.paint(line, context.region, stroke, shift)
        paint.write(readings(placed, frame))

    def _figure(self, key: Hashable, shown: Plotted, room: Rect, scale: float) -> Figure | None:
        if key not in self._figures:
            if len(self._figures) >= paint.REMEMBERED:
                self._figures.pop(next(iter(self._figures)))
            self._figures[key] = arranged(shown, room, scale)
        return self._figures[key]


def arranged(shown: Plotted, room: Rect, scale: float) -> Figure | None:
    """The charts in a free room; None where that is too small or nothing is to be shown."""
    charts = shown.charts()
    places = cards(room, len(charts), scale)
    return figure(charts, shown.asked.phases, places, scale, paint.text_width)


def _wanted(context: bpy.types.Context) -> Plotted | None:
    view = context.scene.hangtime.view
    if not (view.show and view.plots and context.space_data.overlay.show_overlays):
        return None
    armature = chosen_armature(context)
    return plotted(armature, view) if armature is not None else None


def _room(context: bpy.types.Context) -> Rect:
    """What bars and the sidebar leave of the viewport, in its px."""
    window = context.region
    overlaps = [
        Overlap(
            region.alignment,
            Rect(
                region.x - window.x,
                region.y - window.y,
                region.x - window.x + region.width,
                region.y - window.y + region.height,
            ),
        )
        for region in context.area.regions
        if region.type != "WINDOW" and _is_open(region, context.space_data)
    ]
    return free_room(window.width, window.height, overlaps)


def _is_open(region: bpy.types.Region, space: bpy.types.SpaceView3D) -> bool:
    """Whether a region is to be seen; the shelf's bar keeps its size when the shelf is closed."""
    closed = region.type == "ASSET_SHELF_HEADER" and not space.show_region_asset_shelf
    return region.width > 1 and region.height > 1 and not closed
