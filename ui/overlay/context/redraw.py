"""The viewport that is being drawn, which overlay and handles look at one after the other."""

from dataclasses import dataclass
from functools import cache

import bpy

from .view_context import ViewContext, read_view


@dataclass
class Redraw:
    """What is read of a viewport once a redraw: from the first of our draw handlers (POST_VIEW) to
    the last (POST_PIXEL), between which Blender places handles and nothing can change."""

    view: ViewContext | None = None
    _known: object = None  # the state of the last one

    def begin(self, context: bpy.types.Context) -> ViewContext | None:
        self.view = read_view(context, self._known)
        if self.view is not None:
            self._known = self.view.state
        return self.view

    def end(self) -> None:
        self.view = None

    def forget(self) -> None:
        """Nothing is drawn any more."""
        self.view = self._known = None


@cache
def redraw() -> Redraw:
    """Blender draws one viewport after the other."""
    return Redraw()


def view_now(context: bpy.types.Context) -> ViewContext | None:
    """As `read_view`, which is asked where no viewport is being drawn."""
    return redraw().view or read_view(context)
