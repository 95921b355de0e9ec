"""Words beside places of the world, drawn over the viewport."""

from collections.abc import Iterable

import blf
import bpy
from mathutils import Matrix, Vector

from ...drawing.editor import ui_scale
from ...drawing.paint import FONT_ID
from ..geometry.shapes import Label

POINTS = 11.0  # size at the interface's usual scale
BESIDE = (10.0, 6.0)  # px from the place
SHADE = (0.0, 0.0, 0.0, 0.8)


def draw(labels: Iterable[Label], context: bpy.types.Context) -> None:
    """Draws labels of the world where they are seen in this viewport."""
    region, view, scale = context.region, context.region_data, ui_scale(context)
    if region is None or view is None:
        return
    blf.size(FONT_ID, POINTS * scale)
    blf.enable(FONT_ID, blf.SHADOW)
    blf.shadow(FONT_ID, 5, *SHADE)
    for label in labels:
        at = on_screen(Vector(label.place), view.perspective_matrix, region.width, region.height)
        if at is not None:
            blf.color(FONT_ID, *label.colour[:3], 1.0)
            blf.position(FONT_ID, at[0] + BESIDE[0] * scale, at[1] + BESIDE[1] * scale, 0.0)
            blf.draw(FONT_ID, label.words)
    blf.disable(FONT_ID, blf.SHADOW)


def on_screen(
    place: Vector, perspective: Matrix, width: int, height: int
) -> tuple[float, float] | None:
    """Pixels from the lower left of a region; None for what is behind the viewer or outside."""
    x, y, _, w = (perspective @ place.to_4d()).to_tuple()
    if w <= 0.0 or max(abs(x), abs(y)) > w:
        return None
    return (0.5 + 0.5 * x / w) * width, (0.5 + 0.5 * y / w) * height
