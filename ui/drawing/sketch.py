"""Flat drawings as data: what is painted in a region, made and tested without a GPU."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from enum import Enum

import numpy as np

from ...bridge.plots.screen import Array, Rect

Colour = tuple[float, float, float, float]  # sRGB and opacity
TextWidth = Callable[[str, float], float]  # width, px, of a text of a size, px


class Align(Enum):
    """Alignment: the part of a text that is at its place."""

    LEFT = 0.0
    CENTRE = 0.5
    RIGHT = 1.0


@dataclass(frozen=True)
class Text:
    """A line of text; x, y: px, of its base line."""

    x: float
    y: float
    words: str
    colour: Colour
    size: float
    align: Align = Align.LEFT


@dataclass(frozen=True)
class Drawing:
    """A finished sketch. triangles (3N, 2) and lines (2M, 2) px, with a colour for each corner."""

    triangles: Array
    fills: Array
    lines: Array
    strokes: Array
    texts: tuple[Text, ...]


@dataclass
class Sketch:
    """Collects shapes, in the order in which they are painted; lines come above areas."""

    _triangles: list[Array] = field(default_factory=list)
    _fills: list[Array] = field(default_factory=list)
    _lines: list[Array] = field(default_factory=list)
    _strokes: list[Array] = field(default_factory=list)
    _texts: list[Text] = field(default_factory=list)

    def area(self, rect: Rect, colour: Colour) -> None:
        """Fills a rectangle."""
        x0, y0, x1, y1 = rect.left, rect.bottom, rect.right, rect.top
        corners = ((x0, y0), (x1, y0), (x1, y1), (x0, y0), (x1, y1), (x0, y1))
        self._triangles.append(np.array(corners, np.float32))
        self._fills.append(_repeated(colour, 6))

    def outline(self, rect: Rect, colour: Colour) -> None:
        """Strokes a rectangle."""
        x0, y0, x1, y1 = rect.left, rect.bottom, rect.right, rect.top
        self.path(((x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)), colour)

    def path(self, points: Sequence[Sequence[float]] | Array, colour: Colour) -> None:
        """Strokes straight lines from point to point, (N, 2)."""
        corners = np.asarray(points, np.float32)
        self.segments(np.stack([corners[:-1], corners[1:]], axis=1), colour)

    def segments(self, ends: Sequence[Sequence[Sequence[float]]] | Array, colour: Colour) -> None:
        """Strokes separate lines, (N, 2, 2): their ends."""
        flat = np.asarray(ends, np.float32).reshape(-1, 2)
        self._lines.append(flat)
        self._strokes.append(_repeated(colour, len(flat)))

    def text(self, text: Text) -> None:
        self._texts.append(text)

    def finished(self) -> Drawing:
        return Drawing(
            _joined(self._triangles, 2),
            _joined(self._fills, 4),
            _joined(self._lines, 2),
            _joined(self._strokes, 4),
            tuple(self._texts),
        )


def _repeated(colour: Colour, count: int) -> Array:
    return np.tile(np.array(colour, np.float32), (count, 1))


def _joined(parts: list[Array], width: int) -> Array:
    return np.concatenate(parts) if parts else np.zeros((0, width), np.float32)
