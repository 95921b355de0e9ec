"""Drawings painted in a region by the GPU: for plots and timeline."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import blf
import bpy
import gpu
import numpy as np

from ...bridge.plots.screen import Array, Rect
from . import batches
from .sketch import Drawing, Sketch, Text

FONT_ID = 0  # Blender's own font
CACHED_DRAWINGS = 8  # a few regions of different sizes


@dataclass(frozen=True)
class DrawingBatches:
    """A drawing whose shapes are on the GPU."""

    areas: gpu.types.GPUBatch | None
    lines: gpu.types.GPUBatch | None
    texts: tuple[Text, ...]


AREAS, LINES = "FLAT_COLOR", "POLYLINE_FLAT_COLOR"  # shaders


def upload(drawing: Drawing) -> DrawingBatches:
    """A drawing's shapes, sent to the GPU. Only while something is drawn."""
    return DrawingBatches(
        _batch(AREAS, drawing.triangles, drawing.fills),
        _batch(LINES, drawing.lines, drawing.strokes),
        drawing.texts,
    )


def _batch(shader: str, corners: Array, colours: Array) -> gpu.types.GPUBatch | None:
    flat = np.zeros((len(corners), 1), np.float32)
    return batches.batch(shader, np.hstack([corners, flat]), colours) if len(corners) else None


def compile_shaders(region: bpy.types.Region) -> None:
    """Draws what nobody sees with each shader: drivers compile one when it first draws."""
    sketch, nowhere, clear = Sketch(), Rect(0.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0)
    sketch.area(nowhere, clear)
    sketch.outline(nowhere, clear)
    paint(upload(sketch.finished()), region, width=1.0)


def paint(
    drawing: DrawingBatches, region: bpy.types.Region, width: float, shift: float = 0.0
) -> None:
    """Paints in a region. width: of lines; shift: by which all is moved to the right; px."""
    matrix: Any = gpu.matrix  # the stubs say that it returns nothing
    gpu.state.blend_set("ALPHA")
    with matrix.push_pop():
        matrix.translate((shift, 0.0))
        for shader, shapes in ((AREAS, drawing.areas), (LINES, drawing.lines)):
            if shapes is not None:
                batches.draw(shapes, shader, width, (region.width, region.height))
    gpu.state.blend_set("NONE")
    write(drawing.texts)


def write(texts: Iterable[Text]) -> None:
    """Writes texts."""
    for text in texts:
        blf.size(FONT_ID, text.size)
        blf.color(FONT_ID, *text.colour)
        x = text.x - text.align.value * blf.dimensions(FONT_ID, text.words)[0]
        blf.position(FONT_ID, round(x), round(text.y), 0.0)
        blf.draw(FONT_ID, text.words)


def text_width(words: str, size: float) -> float:
    """Width, px, of a text."""
    blf.size(FONT_ID, size)
    return float(blf.dimensions(FONT_ID, words)[0])
