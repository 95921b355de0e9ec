"""Contacts' and phases' bars as a drawing, with their colours and sizes."""

import numpy as np

from ...bridge.plots.screen import Array, Rect
from ...operators.timeline.contact_bars import Bar, Bars
from ..drawing.sketch import Align, Colour, Drawing, Sketch, Text, TextWidth

BACK: Colour = (0.05, 0.05, 0.06, 0.55)
LEFT: Colour = (0.3, 0.55, 0.95, 0.75)
RIGHT: Colour = (0.95, 0.5, 0.3, 0.75)
OTHER: Colour = (0.5, 0.75, 0.4, 0.75)
GROUND: Colour = (0.55, 0.5, 0.42, 0.85)
FLIGHT: Colour = (0.3, 0.42, 0.7, 0.45)
DOUBT: Colour = (0.85, 0.65, 0.1, 0.85)
EDGE: Colour = (1.0, 1.0, 1.0, 0.85)
CHOSEN: Colour = (1.0, 1.0, 1.0, 1.0)
UNUSED: Colour = (0.7, 0.7, 0.7, 0.55)
WORDS: Colour = (1.0, 1.0, 1.0, 1.0)
FAINT: Colour = (0.75, 0.75, 0.78, 0.9)

# px at an interface scale of 1
INSET = 1.0  # between rows
FONT = 10.0
READABLE = 12.0  # a row that is lower holds no words
PADDING = 5.0
GRIP = 2.0  # width of an edge
HATCH = 7.0  # between the strokes over what does not count
STROKE = 1.0


def drawn(bars: Bars, measure: TextWidth) -> Drawing:
    """The bars as far as they are in sight, their edges, and names where there is room."""
    sketch = Sketch()
    sketch.area(bars.room, BACK)
    for index, row in enumerate(bars.rows):
        room = bars.row(index)
        inset = INSET * bars.scale
        for bar in row.bars:
            left, right = bars.axis.at(bar.start), bars.axis.at(bar.end)
            rect = Rect(left, room.bottom + inset, right, room.top - inset)
            if rect.right > room.left and rect.left < room.right:
                _draw_bar(sketch, bar, rect, room, bars.scale, measure)
    return sketch.finished()


def _draw_bar(
    sketch: Sketch, bar: Bar, rect: Rect, room: Rect, scale: float, measure: TextWidth
) -> None:
    seen = Rect(max(rect.left, room.left), rect.bottom, min(rect.right, room.right), rect.top)
    if bar.used:
        sketch.area(seen, _colour(bar))
    else:
        sketch.segments(hatch(seen, HATCH * scale), UNUSED)
        sketch.outline(seen, UNUSED)
    if bar.used and not bar.firm:
        wide = GRIP * scale
        for left in (rect.left, rect.right - wide):
            if room.left <= left <= room.right:
                sketch.area(Rect(left, rect.bottom, left + wide, rect.top), EDGE)
    if bar.chosen:
        sketch.outline(seen, CHOSEN)
    size, padding = FONT * scale, PADDING * scale
    fits = measure(bar.name, size) + 2.0 * padding <= seen.width
    if fits and rect.height >= (READABLE - 2.0 * INSET) * scale:
        colour = WORDS if bar.used else FAINT
        y = 0.5 * (rect.bottom + rect.top) - 0.35 * size
        sketch.text(_name(bar, seen, y, padding, colour, size))


def _name(bar: Bar, seen: Rect, y: float, padding: float, colour: Colour, size: float) -> Text:
    """Contacts' names stay at the left edge in sight; phases' are in the middle."""
    if bar.is_phase:
        return Text(0.5 * (seen.left + seen.right), y, bar.name, colour, size, Align.CENTRE)
    return Text(seen.left + padding, y, bar.name, colour, size)


def _colour(bar: Bar) -> Colour:
    if bar.is_doubt:
        return DOUBT
    if bar.is_phase:
        return FLIGHT if bar.firm else GROUND
    if bar.name.startswith("Left"):
        return LEFT
    return RIGHT if bar.name.startswith("Right") else OTHER


def hatch(rect: Rect, apart: float) -> Array:
    """Strokes at 45 degrees that fill a rectangle, (N, 2, 2) px: their ends."""
    starts = np.arange(rect.left - rect.height, rect.right, apart)
    low = np.maximum(starts, rect.left)
    high = np.minimum(starts + rect.height, rect.right)
    ends = [[x, rect.bottom + x - starts] for x in (low, high)]
    return np.asarray(ends, np.float32).transpose(2, 0, 1)
