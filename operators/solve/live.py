"""Live preview: the motion that follows a dragged pin, shown as a ghost, never written."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import bpy

from ...bridge.accessors import present
from ...solver.data.traces import Traces
from ...solver.worker.protocol import Followed


@dataclass
class Live:
    """The ghost of the armature with that name; version counts its updates."""

    armature: str = ""
    seen: Followed | None = None
    version: int = 0

    def show(self, armature: str, seen: Followed) -> None:
        """The motion has come a little further."""
        self.armature, self.seen = armature, seen
        self.version += 1
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


def redraw_viewports() -> None:
    """Every 3D viewport is drawn again."""
    for window in present(bpy.context.window_manager).windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()
