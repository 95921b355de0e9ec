"""A figure of charts as pictures: one that stays, and one of the playhead that is shifted."""

from math import floor

import numpy as np

from ...bridge.plots.curves import Cap, Curve
from ...bridge.plots.screen import Rect
from ..drawing.sketch import Align, Colour, Drawing, Sketch, Text, TextWidth
from . import looks
from .figure import ChartPanel, PlotFigure
from .numbers import number, thinned

WHOLE = 0.05  # a frame that is nearer to a whole one is written as that


def still(figure: PlotFigure, measure: TextWidth) -> Drawing:
    """All that does not depend on the scene's frame."""
    sketch = Sketch()
    for panel in figure.panels:
        sketch.area(panel.card, looks.CARD)
        _draw_head(sketch, panel, figure.scale, measure)
        if not panel.chart.curves:
            _draw_missing(sketch, panel, figure.scale)
            continue
        _draw_phases(sketch, figure, panel, measure)
        _draw_values(sketch, panel, figure.scale)
        _draw_frames(sketch, panel, figure.scale)
        for curve in reversed(panel.chart.curves):  # parts below their whole
            _draw_curve(sketch, panel, curve)
        for cap in panel.chart.caps:
            _draw_cap(sketch, panel, cap, figure.scale)
    return sketch.finished()


def playhead(figure: PlotFigure) -> Drawing:
    """A line through every chart, at its first frame, and a plate for the frame's number."""
    sketch = Sketch()
    for panel in figure.panels:
        if not panel.chart.curves:
            continue
        left, half = panel.plot.left, 0.5 * looks.PLATE_WIDTH * figure.scale
        bottom = panel.card.bottom + 1.5 * figure.scale
        top = panel.plot.bottom - 1.0
        sketch.area(Rect(left - half, bottom, left + half, top), looks.PLATE)
        sketch.path(((left, top), (left, panel.plot.top)), looks.PLAYHEAD)
    return sketch.finished()


def readings(figure: PlotFigure, frame: float) -> list[Text]:
    """Texts that change with the frame: its number, those beside it, each curve's value."""
    shift, scale = figure.playhead(frame), figure.scale
    size = looks.SMALL * scale
    hidden = 0.5 * (looks.PLATE_WIDTH + looks.TICK_WIDTH) * scale
    texts = [] if shift is None else figure.printed(frame)
    for panel in figure.panels:
        if not panel.chart.curves:
            continue
        left, right, y = panel.plot.left, panel.card.right, panel.card.bottom + 4.0 * scale
        for tick in panel.frame_ticks:
            x = panel.frames.at(tick)
            clear = shift is None or abs(x - left - shift) > hidden
            if clear and x + 0.5 * looks.TICK_WIDTH * scale < right:
                texts.append(Text(x, y, number(tick, 0), looks.FAINT, size, Align.CENTRE))
        if shift is not None:
            words = number(frame, 0 if abs(frame - round(frame)) < WHOLE else 1)
            texts.append(Text(left + shift, y, words, looks.TITLE, size, Align.CENTRE))
    return texts


def _draw_phases(sketch: Sketch, figure: PlotFigure, panel: ChartPanel, measure: TextWidth) -> None:
    size = looks.SMALL * figure.scale
    axis, plot = panel.frames, panel.plot
    for phase in figure.phases:
        left = max(axis.at(phase.start), plot.left)
        right = min(axis.at(phase.end), plot.right)
        if right <= left:
            continue
        sketch.area(Rect(left, plot.bottom, right, plot.top), looks.BANDS[phase.kind])
        words = next((w for w in _names(phase.name) if measure(w, size) < right - left), "")
        if words:
            y = plot.top - 10.0 * figure.scale
            sketch.text(Text(0.5 * (left + right), y, words, looks.FAINT, size, Align.CENTRE))


def _names(name: str) -> tuple[str, ...]:
    """A phase's name and what may stand for it where it is narrow ("g2")."""
    kind, _, count = name.partition(" ")
    return name, f"{kind[:1]}{count}"


def _draw_head(sketch: Sketch, panel: ChartPanel, scale: float, measure: TextWidth) -> None:
    """The title with its unit, and below it the legend."""
    size, padding = looks.FONT * scale, looks.PADDING * scale
    x, y = panel.card.left + padding, panel.card.top - padding - 10.0 * scale
    sketch.text(Text(x, y, panel.chart.title, looks.TITLE, size))
    unit = f"({panel.chart.unit})"
    unit_x = x + measure(f"{panel.chart.title} ", size)
    if unit_x + measure(unit, size) < panel.card.right - padding:
        sketch.text(Text(unit_x, y, unit, looks.FAINT, size))
    for reading in panel.readings:
        middle = reading.y + 0.35 * size
        ends = ((reading.x, middle), (reading.x + looks.SWATCH * scale, middle))
        sketch.path(ends, _colour(reading.curve))
        label_x = reading.x + (looks.SWATCH + looks.LABEL_GAP) * scale
        sketch.text(Text(label_x, reading.y, reading.label, looks.WORDS, size))


def _draw_missing(sketch: Sketch, panel: ChartPanel, scale: float) -> None:
    x, y = 0.5 * (panel.card.left + panel.card.right), 0.5 * (panel.plot.bottom + panel.plot.top)
    words = panel.chart.missing
    sketch.text(Text(x, y, words, looks.FAINT, looks.FONT * scale, Align.CENTRE))


def _draw_values(sketch: Sketch, panel: ChartPanel, scale: float) -> None:
    plot, size = panel.plot, looks.SMALL * scale
    for tick in panel.value_ticks:
        y = panel.values.at(tick)
        sketch.path(((plot.left, y), (plot.right, y)), looks.GRID)
        words = number(tick, panel.value_digits)
        x = plot.left - looks.LABEL_GAP * scale
        sketch.text(Text(x, y - 0.35 * size, words, looks.FAINT, size, Align.RIGHT))


def _draw_frames(sketch: Sketch, panel: ChartPanel, scale: float) -> None:
    plot = panel.plot
    for tick in panel.frame_ticks:
        x = panel.frames.at(tick)
        sketch.path(((x, plot.bottom), (x, plot.bottom - 3.0 * scale)), looks.FAINT)


def _draw_curve(sketch: Sketch, panel: ChartPanel, curve: Curve) -> None:
    frames, values = thinned(curve.frames, curve.values, max(2, floor(panel.plot.width)))
    points = np.stack([panel.frames.all_at(frames), panel.values.all_at(values)], axis=1)
    sketch.path(points, _colour(curve))


def _colour(curve: Curve) -> Colour:
    return looks.PART if curve.part else looks.TAKES[curve.take]


def _draw_cap(sketch: Sketch, panel: ChartPanel, cap: Cap, scale: float) -> None:
    """A dashed line with its value; an arrow up where it lies beyond the axis."""
    plot, size = panel.plot, looks.SMALL * scale
    left = max(panel.frames.at(cap.start), plot.left)
    right = min(panel.frames.at(cap.end), plot.right)
    if right <= left:
        return
    words = number(cap.value, 1 if cap.value < 10.0 else 0)
    beyond = cap.value > panel.values.last
    y = plot.top if beyond else panel.values.at(cap.value)
    if not beyond:
        starts = np.arange(left, right, 2.0 * looks.DASH * scale)
        ends = np.minimum(starts + looks.DASH * scale, right)
        level = np.full(len(starts), y)
        dashes = np.stack([np.stack([starts, level], 1), np.stack([ends, level], 1)], 1)
        sketch.segments(dashes, looks.CAP)
    above = y + 3.0 * scale if y + size + 3.0 * scale < plot.top else y - size
    text = f"{cap.name} {words} ↑" if beyond else f"{cap.name} {words}"
    sketch.text(Text(right - 2.0 * scale, above, text, looks.CAP, size, Align.RIGHT))
