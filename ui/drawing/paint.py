"""Sketches painted in a region: the only part of plots and timeline that uses the GPU."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import blf
import numpy as np

from .sketch import Array, Picture, Text

if TYPE_CHECKING:
    import bpy
    import gpu

FONT = 0
REMEMBERED = 8  # pictures; a few regions of different sizes


@dataclass(frozen=True)
class Painting:
    """A picture whose shapes are on the GPU."""

    areas: gpu.types.GPUBatch | None
    lines: gpu.types.GPUBatch | None
    texts: tuple[Text, ...]


class Easel:
    """Paints pictures, which are made and sent to the GPU once for each key."""

    def __init__(self) -> None:
        self._paintings: OrderedDict[Hashable, Painting] = OrderedDict()

    def painting(self, key: Hashable, make: Callable[[], Picture]) -> Painting:
        """The painting of a key; `make` is called where there is none yet."""
        if key not in self._paintings:
            self._paintings[key] = _prepared(make())
            if len(self._paintings) > REMEMBERED:
                self._paintings.popitem(last=False)
        self._paintings.move_to_end(key)
        return self._paintings[key]


def paint(painting: Painting, region: bpy.types.Region, width: float, shift: float = 0.0) -> None:
    """Paints in a region. width: of lines; shift: by which all is moved to the right; px."""
    import gpu  # not at the top: a Blender without a window has none

    gpu.state.blend_set("ALPHA")
    with gpu.matrix.push_pop():
        gpu.matrix.translate((shift, 0.0))
        if painting.areas is not None:
            painting.areas.draw(gpu.shader.from_builtin("FLAT_COLOR"))
        if painting.lines is not None:
            shader = gpu.shader.from_builtin("POLYLINE_FLAT_COLOR")
            shader.bind()
            shader.uniform_float("viewportSize", (region.width, region.height))
            shader.uniform_float("lineWidth", width)
            painting.lines.draw(shader)
    gpu.state.blend_set("NONE")
    write(painting.texts)


def write(texts: Iterable[Text]) -> None:
    """Writes texts."""
    for text in texts:
        blf.size(FONT, text.size)
        blf.color(FONT, *text.colour)
        x = text.x - text.align.value * blf.dimensions(FONT, text.words)[0]
        blf.position(FONT, round(x), round(text.y), 0.0)
        blf.draw(FONT, text.words)


def text_width(words: str, size: float) -> float:
    """Width, px, of a text."""
    blf.size(FONT, size)
    return float(blf.dimensions(FONT, words)[0])


def _prepared(picture: Picture) -> Painting:
    return Painting(
        _batch("FLAT_COLOR", "TRIS", picture.triangles, picture.fills),
        _batch("POLYLINE_FLAT_COLOR", "LINES", picture.lines, picture.strokes),
        picture.texts,
    )


def _batch(shader: str, kind: str, corners: Array, colours: Array) -> gpu.types.GPUBatch | None:
    import gpu
    from gpu_extras.batch import batch_for_shader

    if len(corners) == 0:
        return None
    flat = np.zeros((len(corners), 1), np.float32)
    content = {"pos": np.hstack([corners, flat]), "color": colours}
    return batch_for_shader(gpu.shader.from_builtin(shader), kind, content)
