"""Which layers there are, by what is switched on."""

from __future__ import annotations

from collections.abc import Iterator

from .context.figure_cache import Figures
from .context.layer import Layer, Part
from .context.view_context import Seen
from .layers import ghosts, limits, motion, pins


def layers(seen: Seen, figures: Figures) -> Iterator[Layer]:
    """All that shall be drawn now; building nothing."""
    view = seen.view
    if view.pins:
        yield pins.contacts(seen)
        yield pins.points(seen)
    if view.limits:
        yield limits.layer(seen, figures)
    if view.poses and (poses := ghosts.poses(seen, figures)) is not None:
        yield poses
    yield from _motion(seen)
    if view.ghosts:
        yield from _ghosts(seen)


def _motion(seen: Seen) -> Iterator[Layer]:
    view, recorded, adapted = seen.view, seen.recorded, seen.adapted
    if view.forces and adapted is not None:
        yield motion.forces(seen, adapted)
    if view.path and recorded is not None:
        yield motion.path(seen, recorded, Part.RECORDED_PATH)
    if view.path and adapted is not None:
        yield motion.path(seen, adapted, Part.ADAPTED_PATH)
    shown = adapted or recorded
    if (view.path or view.momentum) and shown is not None:
        yield motion.centre(seen, shown)


def _ghosts(seen: Seen) -> Iterator[Layer]:
    if seen.recorded is not None and seen.view.recording_too:
        yield ghosts.row(seen, seen.recorded, Part.RECORDED_GHOSTS)
    if seen.adapted is not None:
        yield ghosts.row(seen, seen.adapted, Part.ADAPTED_GHOSTS)
    if (now := ghosts.other_now(seen)) is not None:
        yield now
