"""The viewport's draw handlers, and what they keep between redraws."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from typing import TYPE_CHECKING

import bpy

from .context.figure_cache import Figures
from .context.view_context import look_at
from .geometry.shapes import Label, Shape
from .layer_selection import layers
from .layers import labels
from .picture_cache import Pictures

if TYPE_CHECKING:
    from .gpu_batches import Drawn


class Overlay:
    """Draws what is seen. Nothing is built again while its content stays."""

    def __init__(self) -> None:
        self._figures = Figures()
        self._pictures: Pictures[Drawn] = Pictures(_upload)
        self._labels: tuple[Label, ...] = ()

    def draw_view(self) -> None:
        """In the world (POST_VIEW)."""
        from .gpu_batches import draw

        self._labels = ()
        seen = look_at(bpy.context)
        if seen is None:
            return
        picture = self._pictures.of(list(layers(seen, self._figures)))
        draw(picture.drawn, bpy.context.preferences.system.ui_scale)
        self._labels = picture.labels if seen.view.labels else ()

    def draw_labels(self) -> None:
        """Over the picture (POST_PIXEL), which follows for the same region."""
        if self._labels:
            labels.draw(self._labels, bpy.context)

    def clear(self) -> None:
        """Forgets everything, the graphics card's memory included."""
        self._figures.clear()
        self._pictures.clear()
        self._labels = ()


def _upload(shapes: Sequence[Shape]) -> Drawn:
    from .gpu_batches import upload  # the graphics card is there only once something is drawn

    return upload(shapes)


def add(undo: ExitStack) -> Overlay:
    """Shows overlays in every 3D viewport until `undo` is closed."""
    overlay = Overlay()
    undo.callback(overlay.clear)
    space = bpy.types.SpaceView3D
    for draw, when in ((overlay.draw_view, "POST_VIEW"), (overlay.draw_labels, "POST_PIXEL")):
        handle = space.draw_handler_add(draw, (), "WINDOW", when)
        undo.callback(space.draw_handler_remove, handle, "WINDOW")
    _redraw()
    undo.callback(_redraw)
    return overlay


def _redraw() -> None:
    managers = getattr(bpy.data, "window_managers", ())  # none while Blender starts
    for window in (window for manager in managers for window in manager.windows):
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()
