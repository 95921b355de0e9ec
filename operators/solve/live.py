"""Live preview: the motion that follows a dragged pin, shown as a ghost, never written."""

import time
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

import bpy

from ...solver.data.status import DragStatus
from ...solver.data.traces import Traces
from ...solver.worker.protocol import Followed

SIDEBAR_EVERY = 0.5  # s; nobody reads numbers that change faster, and drawing it takes longest


@dataclass
class Live:
    """The ghost of the armature with that name; version counts its updates."""

    armature: str = ""
    seen: Followed | None = None
    version: int = 0
    told: float = 0.0  # s, when the sidebar was last drawn for it

    def show(self, armature: str, seen: Followed) -> None:
        """The motion has come a little further."""
        now = time.monotonic()
        if self.seen is None:  # the first one does not wait for the sidebar's drawing
            self.told = now
        self.armature, self.seen = armature, seen
        self.version += 1
        if seen.status is DragStatus.CONVERGING and now - self.told < SIDEBAR_EVERY:
            redraw_views()
        else:
            self.told = now
            redraw_viewports()

    def clear(self) -> None:
        """No ghost any more."""
        if self.seen is not None:
            self.seen = None
            self.version += 1
            redraw_viewports()

    def ghost(self, armature: bpy.types.Object) -> Traces | None:
        """The preview of an armature's motion; m, world."""
        mine = self.seen is not None and armature.name == self.armature
        return self.seen.traces if mine and self.seen is not None else None


@cache
def live() -> Live:
    """The one ghost of this Blender."""
    return Live()


def editors(*kinds: str) -> Iterator[bpy.types.Area]:
    """The editors of these kinds, such as "VIEW_3D", in every window."""
    for manager in getattr(bpy.data, "window_managers", ()):  # none while Blender starts
        for window in manager.windows:
            yield from (area for area in window.screen.areas if area.type in kinds)


def redraw(*kinds: str) -> None:
    """Every editor of these kinds is drawn again."""
    for area in editors(*kinds):
        area.tag_redraw()


def redraw_viewports() -> None:
    """Every 3D viewport is drawn again."""
    redraw("VIEW_3D")


def redraw_views() -> None:
    """Every 3D viewport is drawn again without its sidebar and bars, a tenth of the work."""
    for area in editors("VIEW_3D"):
        for region in area.regions:
            if region.type == "WINDOW":
                region.tag_redraw()


def clear_header(area: bpy.types.Area) -> None:
    """An editor's header says its own again; it may be freed, with its window or workspace."""
    if any(area == each for screen in bpy.data.screens for each in screen.areas):
        area.header_text_set(None)
