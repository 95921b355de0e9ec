"""Curves of one trial as SVG: the fit's forces, the plates' and plain differentiation's."""

from collections.abc import Iterator

import numpy as np

from ...solver.arrays import FloatArray
from ..filters import differentiated, low_pass
from .trials import FEET, GroundForces, Trial

WIDTH, HEIGHT, LEFT, TOP = 900, 150, 60, 30  # px, of a panel
CUT_OFF = 15.0  # Hz, of all but the thin line
PLATES, OURS, PLAIN = "#222222", "#d1481f", "#3a7fc2"
AXES = (("up", 2), ("forward", 0), ("left", 1))


def picture(trial: Trial, ours: GroundForces) -> str:
    """The sum's three components and each foot's vertical force, body weights over seconds."""
    plates, cut = trial.plates, CUT_OFF
    rate = (len(trial.com_times) - 1) / float(trial.com_times[-1] - trial.com_times[0])
    plain = low_pass(differentiated(trial.com, rate), rate, cut)
    smooth = [low_pass(f.feet, f.rate, cut) for f in (ours, plates)]
    panels = [
        (
            f"sum, {name}",
            [
                _Line(PLAIN, 1.0, trial.com_times, plain[:, axis]),
                _Line(OURS, 0.4, ours.times, ours.total[:, axis]),
                _Line(PLATES, 1.6, plates.times, smooth[1].sum(axis=1)[:, axis]),
                _Line(OURS, 1.6, ours.times, smooth[0].sum(axis=1)[:, axis]),
            ],
        )
        for name, axis in AXES
    ]
    panels += [
        (
            f"{foot.lower()} foot, up",
            [
                _Line(OURS, 0.4, ours.times, ours.feet[:, side, 2]),
                _Line(PLATES, 1.6, plates.times, smooth[1][:, side, 2]),
                _Line(OURS, 1.6, ours.times, smooth[0][:, side, 2]),
            ],
        )
        for side, foot in enumerate(FEET)
    ]
    return "\n".join(_document(trial, panels)) + "\n"


class _Line:
    """A curve: its colour, width in px, instants (T,) s and values (T,)."""

    def __init__(self, colour: str, width: float, times: FloatArray, values: FloatArray) -> None:
        self.colour, self.width, self.times, self.values = colour, width, times, values


def _document(trial: Trial, panels: list[tuple[str, list[_Line]]]) -> Iterator[str]:
    height = TOP + len(panels) * HEIGHT + 20
    yield (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" '
        'font-family="sans-serif" font-size="11">'
    )
    yield f'<rect width="{WIDTH}" height="{height}" fill="white"/>'
    words = (
        f"{trial.name}: ground force, body weights, low-passed at {CUT_OFF:g} Hz: "
        f'<tspan fill="{OURS}">the fit (thin: as it is)</tspan>, '
        f'<tspan fill="{PLATES}">plates</tspan>, '
        f'<tspan fill="{PLAIN}">plain differentiation</tspan>'
    )
    yield f'<text x="{LEFT}" y="18">{words}</text>'
    for i, (name, lines) in enumerate(panels):
        yield from _panel(name, lines, trial, TOP + i * HEIGHT)
    yield "</svg>"


def _panel(name: str, lines: list[_Line], trial: Trial, top: float) -> Iterator[str]:
    start, end = trial.valid
    seen = [line.values[(line.times >= start) & (line.times <= end)] for line in lines[-2:]]
    low, high = min(v.min() for v in seen) - 0.1, max(v.max() for v in seen) + 0.3
    inner = HEIGHT - 20

    def x(t: FloatArray) -> FloatArray:
        return np.asarray(LEFT + (t - start) / (end - start) * (WIDTH - LEFT - 10))

    def y(value: FloatArray) -> FloatArray:
        return np.asarray(top + inner * (high - np.clip(value, low, high)) / (high - low))

    first, last = (float(x(np.array(t))) for t in trial.compared)
    yield (
        f'<rect x="{first:.1f}" y="{top}" width="{last - first:.1f}" height="{inner}" '
        'fill="#f4f4f4"/>'
    )
    for value in np.arange(np.ceil(low), high):
        at = float(y(np.array(value)))
        yield f'<path d="M{LEFT} {at:.1f}H{WIDTH - 10}" stroke="#cccccc"/>'
        yield f'<text x="{LEFT - 6}" y="{at + 4:.1f}" text-anchor="end">{value:g}</text>'
    for tick in np.arange(np.ceil(10 * start), 10 * end + 1e-9) / 10:
        at = float(x(np.array(tick)))
        label = f"{tick:.1f}"
        yield f'<text x="{at:.1f}" y="{top + inner + 12}" text-anchor="middle">{label}</text>'
    for line in lines:
        inside = (line.times >= start) & (line.times <= end)
        xs, ys = x(line.times[inside]), y(line.values[inside])
        points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(xs, ys, strict=True))
        yield (
            f'<polyline points="{points}" fill="none" stroke="{line.colour}" '
            f'stroke-width="{line.width}"/>'
        )
    yield f'<text x="{LEFT + 6}" y="{top + 14}" font-weight="bold">{name}</text>'
