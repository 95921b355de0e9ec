"""Mouse in a 3D viewport: view rays, projection, and telling a drag from a click."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
from bpy_extras import view3d_utils

from ...bridge.accessors import present
from .rays import Ray

SLACK = 3.0  # px, at an interface scale of 1, until a click becomes a drag

CONFIRM = {"RET", "NUMPAD_ENTER"}
BACK = {"ESC", "RIGHTMOUSE"}
GIVEN = {"HIDDEN", "SKIP_SAVE"}  # options of a property that only a gizmo or a keymap gives

Pixel = tuple[float, float]


def ray_at(context: bpy.types.Context, at: Pixel) -> Ray:
    """Through a pixel of the 3D viewport's region; Blender units, world."""
    region, view = present(context.region), present(context.region_data)
    origin = view3d_utils.region_2d_to_origin_3d(region, view, at)
    along = view3d_utils.region_2d_to_vector_3d(region, view, at)
    return Ray.of(origin.to_tuple(), along.to_tuple())


def pixel_of(context: bpy.types.Context, place: Sequence[float]) -> Pixel | None:
    """Projection of a place (Blender units, world) to a pixel; None behind the viewer."""
    region, view = present(context.region), present(context.region_data)
    at = view3d_utils.location_3d_to_region_2d(region, view, place)
    return (at.x, at.y) if at is not None else None


def pixel(event: bpy.types.Event) -> Pixel:
    """Mouse position in the region."""
    return event.mouse_region_x, event.mouse_region_y


def over_bar(context: bpy.types.Context, event: bpy.types.Event) -> bool:
    """Whether the mouse is over a bar of the viewport, such as the sidebar."""
    bars = (region for region in present(context.area).regions if region.type != "WINDOW")
    return any(
        0 <= event.mouse_x - bar.x < bar.width and 0 <= event.mouse_y - bar.y < bar.height
        for bar in bars
    )


@dataclass
class Press:
    """Where the mouse takes hold. A click moves nothing, however it trembles, and neither does the
    way from a button in a bar into the view."""

    at: Pixel
    slack: float
    dragging: bool
    over_bar: bool = False

    @staticmethod
    def of(context: bpy.types.Context, event: bpy.types.Event, *, click: bool) -> Press:
        """click: whether it may still be one, as the button is down, on a handle in the view."""
        slack = SLACK * present(context.preferences).system.ui_scale
        outside = not click and over_bar(context, event)
        return Press(pixel(event), slack, dragging=not click, over_bar=outside)

    def drags(self, context: bpy.types.Context, event: bpy.types.Event) -> bool:
        """True once it has become a drag."""
        x, y = pixel(event)
        if self.over_bar:
            self.at, self.over_bar = (x, y), over_bar(context, event)
            return False
        self.dragging = self.dragging or max(abs(x - self.at[0]), abs(y - self.at[1])) > self.slack
        return self.dragging
