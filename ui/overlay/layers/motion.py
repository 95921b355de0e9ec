"""Paths of the centre of mass, parabolas, forces and angular momentum of traced motions."""

from collections.abc import Iterator

import numpy as np

from ....solver.arrays import FloatArray
from ....solver.data.constants import STANDARD_GRAVITY
from ....solver.data.traces import UNSEEN_SUPPORT, Traces
from ...drawing.sketch import Colour
from ..context.layer import Layer, Part
from ..context.view_context import ShownMotion, ViewContext
from ..geometry import palette, solids
from ..geometry.shapes import Label, Look, Shape, dashed, faded, polyline, rings

PER_WEIGHT = 0.32  # m an arrow is long for one body weight
LEAST_FORCE = 0.03  # body weights; less is not drawn
LEAST_SAID = 0.1  # body weights; less is not written
SHAFT = 0.011  # m, radius of an arrow
PER_MOMENTUM = 1.6  # s, an arrow's length per angular momentum and kg
DASH, GAP = 0.05, 0.035  # m, of a parabola
CORNERS = 600  # of a path at most: of 23 s at 120 frames a second still 24 in each
CENTRE = 0.03  # m, radius of the centre of mass

# Sizes are those of a grown person's figure; each is drawn as many times larger as its figure is.


def forces(view: ViewContext, shown: ShownMotion) -> Layer:
    """Of the contacts at this frame."""
    traces, frame, size = shown.traces, view.frame, view.size
    content = shown.key, frame, size
    return Layer(Part.FORCES, content, lambda: force_shapes(traces, frame, size), shown.matrix)


def force_shapes(traces: Traces, frame: float, size: float) -> Iterator[Shape | Label]:
    """m, world."""
    if not traces.contacts or not within(traces, frame):
        return
    points, pushes = (interpolated(traces, a, frame) for a in (traces.points, traces.forces))
    weights = pushes / max(traces.weight, 1e-9)
    unseen = np.array([name == UNSEEN_SUPPORT for name in traces.contacts])
    if unseen.any():
        yield from _unseen(points[unseen].mean(axis=0), weights[unseen].sum(axis=0), size)
        points, weights = points[~unseen], weights[~unseen]
    total, strength = weights.sum(axis=0), np.linalg.norm(weights, axis=1)
    shown = strength > LEAST_FORCE
    vectors = PER_WEIGHT * size * weights[shown]
    yield solids.arrows(points[shown], vectors, SHAFT * size, palette.FORCE)
    if np.linalg.norm(total) > LEAST_SAID:
        largest = int(strength.argmax())
        tip = points[largest] + PER_WEIGHT * size * weights[largest]
        words = f"{np.linalg.norm(total):.1f} body weights"
        yield Label(words, tuple(tip.tolist()), palette.FORCE)


def _unseen(point: FloatArray, weights: FloatArray, size: float) -> Iterator[Shape | Label]:
    """What carries the body unseen: one arrow, in a colour of its own."""
    strength = float(np.linalg.norm(weights))
    if strength > LEAST_FORCE:
        vector = PER_WEIGHT * size * weights
        yield solids.arrows(point[None], vector[None], SHAFT * size, palette.UNSEEN)
        words = f"Unseen: {strength:.1f} body weights"
        yield Label(words, tuple((point + vector).tolist()), palette.UNSEEN)


def path(view: ViewContext, shown: ShownMotion, part: Part) -> Layer:
    """Way of the centre of mass; flights as parabolas."""
    colour = _colour_of(view, part)
    content = shown.key, view.size, colour
    return Layer(part, content, lambda: path_shapes(shown.traces, colour, view.size), shown.matrix)


def _colour_of(view: ViewContext, part: Part) -> Colour:
    if part is Part.RECORDED_PATH:
        return faded(palette.RECORDED, 0.6)
    return palette.LIVE if view.live is not None else palette.ADAPTED


def path_shapes(traces: Traces, colour: Colour, size: float) -> Iterator[Shape]:
    """m, world."""
    for start, end in on_ground(traces):
        places = traces.com[(traces.frames >= start) & (traces.frames <= end)]
        step = -(-len(places) // CORNERS)
        if len(places) > 1:
            few = np.concatenate([places[:-1:step], places[-1:]])
            yield polyline(few, colour, Look.BOLD if traces.flights else Look.THIN)
    for flight in traces.flights:
        dash, gap = DASH * size, GAP * size
        yield dashed(flight.parabola, palette.PARABOLA, dash=dash, gap=gap, look=Look.BOLD)


def on_ground(traces: Traces) -> list[tuple[float, float]]:
    """From which frame to which no flight is, with the frames next to them."""
    edges = [-np.inf]
    for flight in sorted(traces.flights, key=lambda f: f.start):
        edges += [float(np.ceil(flight.start)), float(np.floor(flight.end))]
    edges.append(np.inf)
    return list(zip(edges[::2], edges[1::2], strict=True))


def centre(view: ViewContext, shown: ShownMotion) -> Layer:
    """The centre of mass at this frame, and the angular momentum about it."""
    traces, frame, size = shown.traces, view.frame, view.size
    marks, spin = view.options.path, view.options.momentum
    content = shown.key, frame, size, marks, spin

    def build() -> Iterator[Shape | Label]:
        if within(traces, frame):
            yield from centre_shapes(traces, frame, size, marks=marks, spin=spin)

    return Layer(Part.CENTRE, content, build, shown.matrix)


def centre_shapes(
    traces: Traces, frame: float, size: float, *, marks: bool, spin: bool
) -> Iterator[Shape | Label]:
    """m, world."""
    at = interpolated(traces, traces.com, frame)
    if marks:
        flying = any(f.start <= frame <= f.end for f in traces.flights)
        colour = palette.PARABOLA if flying else palette.ADAPTED
        yield solids.balls(at, 0.6 * CENTRE * size, colour)
        yield rings(at, CENTRE * size, faded(colour, 0.6))
    momentum = interpolated(traces, traces.momentum, frame)
    if spin:
        along = momentum * PER_MOMENTUM * STANDARD_GRAVITY / max(traces.weight, 1e-9) * size
        yield solids.arrows(at, along, 0.9 * SHAFT * size, palette.MOMENTUM)
        words = f"{np.linalg.norm(momentum):.1f} N·m·s"
        yield Label(words, tuple((at + along).tolist()), palette.MOMENTUM)


def within(traces: Traces, frame: float) -> bool:
    """Whether the motion reaches a frame."""
    return bool(traces.frames[0] - 0.5 <= frame <= traces.frames[-1] + 0.5)


def interpolated(traces: Traces, values: FloatArray, frame: float) -> FloatArray:
    """Linear interpolation of values (T, ...) at a frame."""
    frames = traces.frames
    after = int(np.clip(np.searchsorted(frames, frame), 0, len(frames) - 1))
    before = max(after - 1, 0)
    spent = frames[after] - frames[before]
    share = np.clip((frame - frames[before]) / spent, 0.0, 1.0) if spent > 0.0 else 1.0
    return np.asarray((1.0 - share) * values[before] + share * values[after])
