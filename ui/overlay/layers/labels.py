"""Words beside places of the world, drawn over the viewport."""

from collections.abc import Iterable

import blf
import bpy
from bpy_extras.view3d_utils import location_3d_to_region_2d

from ...drawing.editor import ui_scale
from ...drawing.paint import FONT_ID
from ..geometry.shapes import Label

POINTS = 11.0  # size at the interface's usual scale
BESIDE = (10.0, 6.0)  # px from the place
OUTLINE = 6  # of Blender's kinds of shadows: a blurred one leaves words over bones unreadable
SHADE = (0.0, 0.0, 0.0, 0.8)


def draw(labels: Iterable[Label], context: bpy.types.Context) -> None:
    """Draws labels of the world where they are seen in this viewport."""
    region, view, scale = context.region, context.region_data, ui_scale(context)
    if region is None or view is None:
        return
    blf.size(FONT_ID, POINTS * scale)
    blf.enable(FONT_ID, blf.SHADOW)
    blf.shadow(FONT_ID, OUTLINE, *SHADE)
    for label in labels:
        at = location_3d_to_region_2d(region, view, label.place)
        if at is not None and 0.0 <= at.x <= region.width and 0.0 <= at.y <= region.height:
            blf.color(FONT_ID, *label.colour[:3], 1.0)
            blf.position(FONT_ID, at.x + BESIDE[0] * scale, at.y + BESIDE[1] * scale, 0.0)
            blf.draw(FONT_ID, label.words)
    blf.disable(FONT_ID, blf.SHADOW)
