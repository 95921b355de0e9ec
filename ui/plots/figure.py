"""Charts laid out in a viewport: axes, legends, and where each curve's value is printed."""

from dataclasses import dataclass

from ...bridge.plots.curves import Chart, Curve
from ...bridge.plots.screen import Axis, Rect, round_range, round_step
from ...bridge.rows.phases import PhaseSpan
from ..drawing.sketch import Text, TextWidth
from . import looks
from .numbers import decimals, number

FAR_CAP = 2.0  # times the largest value; a cap beyond would flatten the curves


@dataclass(frozen=True)
class Reading:
    """A curve's name in the legend, and where its value at the playhead is printed."""

    curve: Curve
    label: str
    x: float
    y: float
    value_x: float


@dataclass(frozen=True)
class ChartPanel:
    """A chart in its card. plot: the rectangle of the curves. ticks: of both axes."""

    chart: Chart
    card: Rect
    plot: Rect
    frames: Axis
    values: Axis
    frame_ticks: tuple[float, ...]
    value_ticks: tuple[float, ...]
    value_digits: int
    readings: tuple[Reading, ...]


@dataclass(frozen=True)
class PlotFigure:
    """All charts, one below or beside the other, over the same frames."""

    panels: tuple[ChartPanel, ...]
    phases: tuple[PhaseSpan, ...]
    scale: float

    @property
    def first(self) -> float:
        return self.panels[0].frames.first

    @property
    def last(self) -> float:
        return self.panels[0].frames.last

    def playhead(self, frame: float) -> float | None:
        """px from the start of every plot to a frame; None where the charts do not hold it."""
        if not self.first <= frame <= self.last:
            return None
        axis = self.panels[0].frames
        return axis.at(frame) - axis.start

    def printed(self, frame: float) -> list[Text]:
        """The curves' values at a frame."""
        size = looks.FONT * self.scale
        return [
            Text(reading.value_x, reading.y, words, looks.TITLE, size)
            for panel in self.panels
            for reading in panel.readings
            if (words := _value_words(reading.curve, frame, panel.chart.digits))
        ]


def lay_out(
    charts: tuple[Chart, ...],
    phases: tuple[PhaseSpan, ...],
    cards: tuple[Rect, ...],
    scale: float,
    measure: TextWidth,
) -> PlotFigure | None:
    """Lays out charts in cards; None where there is nothing to be shown."""
    frames = [f for c in charts for curve in c.curves for f in (curve.frames[0], curve.frames[-1])]
    if not frames or not cards or min(frames) == max(frames):
        return None
    span = (float(min(frames)), float(max(frames)))
    shown = list(zip(charts, cards, strict=False))
    axes = [_value_axis(chart, _plot(card, 0.0, scale), scale) for chart, card in shown]
    # One width of labels for all, so that the playhead is at the same place in each.
    margin = max(
        measure(number(tick, axis[2]), looks.SMALL * scale) for axis in axes for tick in axis[1]
    )
    panels = []
    for (chart, card), (values, ticks, digits) in zip(shown, axes, strict=True):
        plot = _plot(card, margin, scale)
        along = Axis(*span, plot.left, plot.right)
        readings = _readings(chart, card, scale, measure)
        frame_ticks = along.ticks(looks.FRAMES_APART * scale, finest=1.0)
        panels.append(
            ChartPanel(chart, card, plot, along, values, frame_ticks, ticks, digits, readings)
        )
    return PlotFigure(tuple(panels), phases, scale)


def _plot(card: Rect, label_width: float, scale: float) -> Rect:
    padding = looks.PADDING * scale
    return Rect(
        card.left + padding + label_width + looks.LABEL_GAP * scale,
        card.bottom + looks.FOOT * scale,
        card.right - padding,
        card.top - padding - 2.0 * looks.LINE * scale,
    )


def _value_axis(chart: Chart, plot: Rect, scale: float) -> tuple[Axis, tuple[float, ...], int]:
    """The axis with round ends, its ticks, and how many digits these need."""
    apart = looks.VALUES_APART * scale
    low, high = _extent(chart)
    parts = max(1, int(plot.height // apart))
    low, high = round_range(low, high, parts)
    axis = Axis(low, high, plot.bottom, plot.top)
    ticks = axis.ticks(apart)
    return axis, ticks, decimals(round_step(apart / axis.per_unit))


def _extent(chart: Chart) -> tuple[float, float]:
    lows = [float(curve.values.min()) for curve in chart.curves]
    highs = [float(curve.values.max()) for curve in chart.curves]
    if not highs:
        return 0.0, 1.0
    near = [cap.value for cap in chart.caps if cap.value <= FAR_CAP * max(highs)]
    low = min(0.0, *lows) if chart.from_zero else min(lows)
    return low, max(*highs, *near, low + 1e-6)


def _readings(chart: Chart, card: Rect, scale: float, measure: TextWidth) -> tuple[Reading, ...]:
    """The legend from left to right; what finds no room is left out."""
    size = looks.FONT * scale
    padding = looks.PADDING * scale
    x, y = card.left + padding, card.top - padding - (2.0 * looks.LINE - 7.0) * scale
    readings = []
    for curve in chart.curves:
        label = curve.part or curve.take.value
        start = x + (looks.SWATCH + looks.LABEL_GAP) * scale
        value = start + measure(f"{label}  ", size)
        extremes = (curve.values.min(), curve.values.max())
        end = value + max(measure(number(v, chart.digits), size) for v in extremes)
        if end > card.right - padding:
            break
        readings.append(Reading(curve, label, x, y, value))
        x = end + 1.5 * padding
    return tuple(readings)


def _value_words(curve: Curve, frame: float, digits: int) -> str:
    value = curve.at(frame)
    return "" if value is None else number(value, digits)
