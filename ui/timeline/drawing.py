"""Contacts' and phases' bars as a drawing."""

import numpy as np

from ...bridge.plots.screen import Array, Rect
from ...operators.timeline.contact_bars import Bar, Bars
from ..drawing.sketch import Align, Colour, Drawing, Sketch, Text, TextWidth
from . import looks


def drawn(bars: Bars, measure: TextWidth) -> Drawing:
    """The bars as far as they are in sight, their edges, and names where there is room."""
    sketch = Sketch()
    sketch.area(bars.room, looks.BACK)
    for index, row in enumerate(bars.rows):
        room = bars.row(index)
        inset = looks.INSET * bars.scale
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
        sketch.segments(hatch(seen, looks.HATCH * scale), looks.UNUSED)
        sketch.outline(seen, looks.UNUSED)
    if bar.used and not bar.firm:
        wide = looks.GRIP * scale
        for left in (rect.left, rect.right - wide):
            if room.left <= left <= room.right:
                sketch.area(Rect(left, rect.bottom, left + wide, rect.top), looks.EDGE)
    if bar.chosen:
        sketch.outline(seen, looks.CHOSEN)
    size, padding = looks.FONT * scale, looks.PADDING * scale
    fits = measure(bar.name, size) + 2.0 * padding <= seen.width
    if fits and rect.height >= (looks.READABLE - 2.0 * looks.INSET) * scale:
        colour = looks.WORDS if bar.used else looks.FAINT
        y = 0.5 * (rect.bottom + rect.top) - 0.35 * size
        sketch.text(_name(bar, seen, y, padding, colour, size))


def _name(bar: Bar, seen: Rect, y: float, padding: float, colour: Colour, size: float) -> Text:
    """Contacts' names stay at the left edge in sight; phases' are in the middle."""
    if bar.is_phase:
        return Text(0.5 * (seen.left + seen.right), y, bar.name, colour, size, Align.CENTRE)
    return Text(seen.left + padding, y, bar.name, colour, size)


def _colour(bar: Bar) -> Colour:
    if bar.is_phase:
        return looks.FLIGHT if bar.firm else looks.GROUND
    if bar.name.startswith("Left"):
        return looks.LEFT
    return looks.RIGHT if bar.name.startswith("Right") else looks.OTHER


def hatch(rect: Rect, apart: float) -> Array:
    """Strokes at 45 degrees that fill a rectangle, (N, 2, 2) px: their ends."""
    starts = np.arange(rect.left - rect.height, rect.right, apart)
    low = np.maximum(starts, rect.left)
    high = np.minimum(starts + rect.height, rect.right)
    ends = [[x, rect.bottom + x - starts] for x in (low, high)]
    return np.asarray(ends, np.float32).transpose(2, 0, 1)
