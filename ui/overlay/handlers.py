"""The viewport's draw handlers, and what they keep between redraws."""

from contextlib import ExitStack

import bpy

from ...operators.solve.live import redraw_viewports
from ..drawing.editor import ui_scale
from .context.figure_cache import FigureCache
from .context.redraw import redraw
from .geometry.shapes import Label, Look
from .gpu_batches import GpuBatches, draw, draw_nothing, upload
from .layer_selection import layers
from .layers import labels
from .picture_cache import PictureCache

WARMING = 0.1  # s from one look to the next


class Overlay:
    """Draws the overlay. Nothing is built again while its content stays.

    A driver compiles a shader when it first draws with it, some 50 ms each: that is done while
    nothing is waited for, a look a redraw, rather than all at once when an analysis is there.
    """

    def __init__(self) -> None:
        self._cold = list(Look)
        self._figures = FigureCache()
        self._pictures: PictureCache[GpuBatches] = PictureCache(upload)
        self._labels: tuple[Label, ...] = ()

    def draw_view(self) -> None:
        """In the world (POST_VIEW)."""
        self._labels = ()
        context = bpy.context
        self._warm_up()
        view = redraw().begin(context)
        if view is None:
            return
        batches, named = self._pictures.of(view.state, lambda: layers(view, self._figures))
        draw(batches, ui_scale(context))
        self._labels = named if view.options.labels else ()

    def _warm_up(self) -> None:
        if self._cold:
            draw_nothing(self._cold.pop())
            bpy.app.timers.register(redraw_viewports, first_interval=WARMING)

    def draw_labels(self) -> None:
        """Over the picture (POST_PIXEL), which follows for the same region."""
        redraw().end()
        if self._labels:
            labels.draw(self._labels, bpy.context)

    def clear(self) -> None:
        """Forgets everything, the graphics card's memory included."""
        self._figures.clear()
        self._pictures.clear()
        self._labels = ()
        redraw().forget()


def add(undo: ExitStack) -> Overlay:
    """Shows overlays in every 3D viewport until `undo` is closed."""
    overlay = Overlay()
    undo.callback(overlay.clear)
    space = bpy.types.SpaceView3D
    for callback, when in ((overlay.draw_view, "POST_VIEW"), (overlay.draw_labels, "POST_PIXEL")):
        handle = space.draw_handler_add(callback, (), "WINDOW", when)
        undo.callback(space.draw_handler_remove, handle, "WINDOW")
    redraw_viewports()
    undo.callback(redraw_viewports)
    return overlay
