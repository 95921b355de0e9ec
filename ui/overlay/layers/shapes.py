"""The body's solid shapes as wires, red where one is in another or in the scene."""

from collections.abc import Iterator, Sequence

import numpy as np

from ....bridge.properties.of_actions.shown_overlaps import ShownOverlap, shown_overlaps
from ....solver.data.traces import Traces
from ..context.layer import Layer, Part
from ..context.view_context import ShownMotion, ViewContext
from ..geometry import palette
from ..geometry.shapes import Label, Look, Shape
from ..geometry.wires import capsules
from .motion import interpolated, within

NEAR = 0.1  # s about its deepest, in which an overlap is marked


def layer(view: ViewContext, shown: ShownMotion) -> Layer:
    """Of a motion at the frame that is shown."""
    traces, frame = shown.traces, view.frame
    now = _overlaps_now(view, adapted=shown is view.adapted)
    content = shown.key, frame, now

    def build() -> Iterator[Shape | Label]:
        if traces.solids and within(traces, frame):
            yield from solid_shapes(traces, frame, now)

    return Layer(Part.SHAPES, content, build, shown.matrix)


def _overlaps_now(view: ViewContext, *, adapted: bool) -> tuple[ShownOverlap, ...]:
    """Those that are marked at this frame; of a motion under way none are known."""
    if view.live is not None:
        return ()
    reach = NEAR * view.rate
    overlaps = shown_overlaps(view.settings.adapted, adapted=adapted)
    return tuple(each for each in overlaps if abs(each.frame - view.frame) <= reach)


def solid_shapes(
    traces: Traces, frame: float, overlaps: Sequence[ShownOverlap]
) -> Iterator[Shape | Label]:
    """m, world."""
    starts, ends = (
        interpolated(traces, a, frame) for a in (traces.solid_starts, traces.solid_ends)
    )
    names = [name.lower() for name in traces.solids]
    marked = {thing for each in overlaps for thing in each.things}
    red = np.array([name in marked for name in names])
    for these, colour, look in (
        (~red, palette.SOLID_SHAPE, Look.THIN),
        (red, palette.OVERLAP, Look.BOLD),
    ):
        yield capsules(starts[these], ends[these], traces.solid_radii[these], colour, look)
    for each in overlaps:
        at = [i for i, name in enumerate(names) if name == each.things[0]]
        if at:
            place = tuple((0.5 * (starts[at[0]] + ends[at[0]])).tolist())
            yield Label(f"{each.name} {each.millimetres:.0f} mm", place, palette.OVERLAP)
