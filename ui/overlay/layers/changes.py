"""The adapted motion's limbs, coloured by how far their joints are turned from the recording's."""

from collections.abc import Iterator

import numpy as np

from ....solver.arrays import FloatArray
from ..context.layer import Layer, Part
from ..context.view_context import ShownMotion, ViewContext
from ..geometry import palette, solids
from ..geometry.shapes import Label, Shape, faded
from .motion import interpolated, within

PLUMP = 1.5  # times as thick as bones, so that they stand out of a mesh
STOPS = (0.0, 15.0, 45.0)  # degrees, of the colours in between
LEAST_SAID = 5.0  # degrees; less is not written
MOST_SAID = 3  # joints


def layer(view: ViewContext, shown: ShownMotion) -> Layer:
    """At the frame that is shown; nothing of motions that were stored without their changes."""
    traces, frame, size = shown.traces, view.frame, view.size

    def build() -> Iterator[Shape | Label]:
        if traces.changes.size and within(traces, frame):
            heads, tails, turned = (
                interpolated(traces, a, frame) for a in (traces.heads, traces.tails, traces.changes)
            )
            yield from change_shapes(heads, tails, np.degrees(turned), size)

    return Layer(Part.CHANGES, (shown.key, frame, size), build, shown.matrix)


def change_shapes(
    heads: FloatArray, tails: FloatArray, turned: FloatArray, size: float
) -> Iterator[Shape | Label]:
    """heads, tails: (B, 3) m, world. turned: (B,) degrees of the bones' joints."""
    long = np.linalg.norm(tails - heads, axis=1) > solids.SHORTEST_SOLID
    yield solids.bodies(
        heads[long], tails[long], change_colours(turned[long]), size=size, plump=PLUMP
    )
    for i in np.argsort(-turned)[:MOST_SAID].tolist():
        if turned[i] >= LEAST_SAID:
            colour = tuple(change_colours(turned[i : i + 1])[0].tolist())
            yield Label(f"{turned[i]:.0f}°", tuple(heads[i].tolist()), colour)


def change_colours(turned: FloatArray) -> FloatArray:
    """(B, 4) colours of turns (B,) in degrees."""
    ends = np.array([faded(palette.UNCHANGED, 0.6), palette.BEYOND, palette.LIMIT])
    return np.stack([np.interp(turned, STOPS, channel) for channel in ends.T], axis=1)
