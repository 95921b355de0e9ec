"""Selection of the layers that are switched on."""

from collections.abc import Iterator

from .context.figure_cache import FigureCache
from .context.layer import Layer, Part
from .context.view_context import ViewContext
from .layers import changes, faults, ghosts, limits, motion, pins, shapes


def layers(view: ViewContext, figures: FigureCache) -> Iterator[Layer]:
    """All that shall be drawn now; building nothing."""
    options = view.options
    if options.pins:
        yield pins.contacts(view)
        yield pins.points(view)
    if options.limits:
        yield limits.layer(view, figures)
    if options.poses and (poses := ghosts.poses(view, figures)) is not None:
        yield poses
    if options.faults and not view.performs_adapted:
        yield faults.layer(view)
    yield from _motion(view)
    if options.ghosts:
        yield from _ghosts(view)


def _motion(view: ViewContext) -> Iterator[Layer]:
    options, recorded, adapted = view.options, view.recorded, view.adapted
    if options.forces and adapted is not None:
        yield motion.forces(view, adapted)
    if options.path and recorded is not None:
        yield motion.path(view, recorded, Part.RECORDED_PATH)
    if options.path and adapted is not None:
        yield motion.path(view, adapted, Part.ADAPTED_PATH)
    if options.changes and view.live is None and adapted is not None:
        yield changes.layer(view, adapted)
    shown = adapted or recorded
    performed = adapted if view.live or view.performs_adapted else recorded
    if options.shapes and performed is not None:
        yield shapes.layer(view, performed)
    if (options.path or options.momentum) and shown is not None:
        yield motion.centre(view, shown)


def _ghosts(view: ViewContext) -> Iterator[Layer]:
    if view.recorded is not None and view.options.recording_too:
        yield ghosts.row(view, view.recorded, Part.RECORDED_GHOSTS)
    if view.adapted is not None:
        yield ghosts.row(view, view.adapted, Part.ADAPTED_GHOSTS)
    if (now := ghosts.other_now(view)) is not None:
        yield now
