"""Pins as shapes, in the world."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from mathutils import Matrix

from ....bridge.shapes.solids import box
from ...drawing.sketch import Colour
from . import palette, solids
from .shapes import Look, Shape, Standing, dotted, faded, lines, rings

RADIUS, MOVED, FOUND = 0.022, 1.4, 0.6  # m, of a figure of usual size; times as large
HALO = 1.7  # radius about the chosen one, times its own

Place = tuple[float, float, float]


class Box(NamedTuple):
    """Bounds about a place. axes: (3, 3) columns, frozen; low, high: along them."""

    axes: Matrix
    low: Place
    high: Place


class Pin(NamedTuple):
    """A ball. Blender units, world; found: from where it was moved."""

    place: Place
    standing: Standing
    hollow: bool = False
    chosen: bool = False
    found: Place | None = None
    box: Box | None = None

    @property
    def colour(self) -> Colour:
        if self.standing is Standing.OFF:
            return palette.PIN_OFF
        return faded(palette.PIN, self.standing)

    @property
    def size(self) -> float:
        if self.standing is Standing.OFF:
            return FOUND
        return MOVED if self.found is not None else 1.0


def shapes(pins: Sequence[Pin], units: float) -> Iterator[Shape]:
    """units: the figure's size in Blender units, of which 1 is a grown person."""
    radius = RADIUS * units
    if full := [pin for pin in pins if not pin.hollow]:
        yield solids.balls(*_spread(full, radius))
    if hollow := [pin for pin in pins if pin.hollow]:
        yield rings(*_spread(hollow, radius), Look.BOLD)
    lit = [pin for pin in pins if pin.standing is not Standing.OFF]
    yield from (
        rings(pin.place, HALO * radius * pin.size, faded(palette.WITHIN, 0.5))
        for pin in lit
        if pin.chosen
    )
    if moved := [(pin, pin.found) for pin in lit if pin.found is not None]:
        found = [place for _, place in moved]
        colours = [faded(palette.MOVE, pin.standing) for pin, _ in moved]
        yield dotted(found, [pin.place for pin, _ in moved], colours)
        yield solids.balls(found, FOUND * radius, [faded(colour, 0.5) for colour in colours])
    for pin in pins:
        if pin.box is not None:
            axes = np.array(pin.box.axes.copy())  # numpy cannot look into frozen ones
            bounds = box(pin.box.low, pin.box.high).placed(axes, np.array(pin.place))
            yield lines(bounds.edges, pin.colour)


def _spread(pins: Sequence[Pin], radius: float) -> tuple[list[Place], list[float], list[Colour]]:
    return [p.place for p in pins], [radius * p.size for p in pins], [p.colour for p in pins]
