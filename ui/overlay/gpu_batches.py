"""Shapes on the graphics card, and the passes in which they are drawn. Built-in shaders only."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import gpu
import numpy as np

from ..drawing import batches
from .geometry.shapes import Look, Shape

WIDTHS = {Look.THIN: 1.4, Look.BOLD: 2.6}  # px at the interface's usual scale
HIDDEN = 0.22  # how much is seen of what is behind something
SEEN_THROUGH = (Look.SOLID, Look.BOLD)  # what is seen behind something at all
SOLID = (Look.SOLID, Look.GHOST)  # what hides its own back


@dataclass(frozen=True)
class GpuBatches:
    """Batches by look; `behind` are the same, fainter, for where they are hidden."""

    front: dict[Look, gpu.types.GPUBatch]
    behind: dict[Look, gpu.types.GPUBatch]


def upload(shapes: Sequence[Shape]) -> GpuBatches:
    """Shapes, at most one for each look, as batches. Only while something is drawn."""
    front = {s.look: _batch(s, 1.0) for s in shapes}
    behind = {s.look: _batch(s, HIDDEN) for s in shapes if s.look in SEEN_THROUGH}
    return GpuBatches(front, behind)


def _batch(shape: Shape, opacity: float) -> gpu.types.GPUBatch:
    colours = shape.colours * np.array((1.0, 1.0, 1.0, opacity), np.float32)
    return batches.batch(_shader(shape.look), shape.points, colours, shape.faces)


def _shader(look: Look) -> str:
    return "POLYLINE_SMOOTH_COLOR" if look.lines else "SMOOTH_COLOR"


def draw(shapes: GpuBatches, scale: float) -> None:
    """Draws what is in the world. scale: of the interface.

    The graphics state is afterwards what it was.
    """
    with _own_state():
        _state("GREATER", writes=False)
        for look, batch in shapes.behind.items():
            _draw(batch, look, scale)
        for look in Look:
            if look in shapes.front:
                _state("LESS_EQUAL", writes=look in SOLID)
                gpu.state.face_culling_set("BACK" if look in SOLID else "NONE")
                _draw(shapes.front[look], look, scale)


def draw_nothing(look: Look) -> None:
    """Draws, in a look with all its states, what is too small to be seen. Only while something is
    drawn."""
    points = np.zeros((2 if look.lines else 3, 3), np.float32)
    draw(upload([Shape(look, points, np.zeros((len(points), 4), np.float32))]), scale=1.0)


def _draw(shapes: gpu.types.GPUBatch, look: Look, scale: float) -> None:
    state: Any = gpu.state  # the stubs say that its getters return nothing
    size = state.viewport_get()[2:]
    batches.draw(shapes, _shader(look), WIDTHS.get(look, 0.0) * scale, size)


def _state(test: str, *, writes: bool) -> None:
    gpu.state.depth_test_set(test)
    gpu.state.depth_mask_set(writes)


@contextmanager
def _own_state() -> Iterator[None]:
    state: Any = gpu.state  # the stubs say that its getters return nothing
    blend, test, writes = state.blend_get(), state.depth_test_get(), state.depth_mask_get()
    state.blend_set("ALPHA")
    try:
        yield
    finally:
        state.face_culling_set("NONE")
        state.blend_set(blend)
        state.depth_test_set(test)
        state.depth_mask_set(writes)
