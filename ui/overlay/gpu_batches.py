"""Shapes on the graphics card, and the passes in which they are drawn. Built-in shaders only."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import gpu
from gpu_extras.batch import batch_for_shader

from .geometry.shapes import Look, Shape

SHADERS = {True: "POLYLINE_SMOOTH_COLOR", False: "SMOOTH_COLOR"}  # whether it is lines
WIDTHS = {Look.THIN: 1.4, Look.BOLD: 2.6}  # px at the interface's usual scale
HIDDEN = 0.22  # how much is seen of what is behind something
SEEN_THROUGH = (Look.SOLID, Look.BOLD)  # what is seen behind something at all
SOLID = (Look.SOLID, Look.GHOST)  # what hides its own back


@dataclass(frozen=True)
class Drawn:
    """Batches by look; `behind` are the same, fainter, for where they are hidden."""

    front: dict[Look, gpu.types.GPUBatch]
    behind: dict[Look, gpu.types.GPUBatch]


def upload(shapes: Sequence[Shape]) -> Drawn:
    """Shapes, at most one for each look, as batches. Only while something is drawn."""
    front = {s.look: _batch(s, 1.0) for s in shapes}
    behind = {s.look: _batch(s, HIDDEN) for s in shapes if s.look in SEEN_THROUGH}
    return Drawn(front, behind)


def _batch(shape: Shape, opacity: float) -> gpu.types.GPUBatch:
    colours = shape.colours if opacity == 1.0 else shape.colours * (1.0, 1.0, 1.0, opacity)
    kind = "LINES" if shape.look.lines else "TRIS"
    content = {"pos": shape.points, "color": colours.astype("float32")}
    return batch_for_shader(_shader(shape.look), kind, content, indices=shape.faces)


def _shader(look: Look) -> gpu.types.GPUShader:
    return gpu.shader.from_builtin(SHADERS[look.lines])


def draw(drawn: Drawn, scale: float) -> None:
    """Draws what is in the world. scale: of the interface.

    The graphics state is afterwards what it was.
    """
    with _own_state():
        _state("GREATER", writes=False)
        for look, batch in drawn.behind.items():
            _draw(batch, look, scale)
        for look in Look:
            if look in drawn.front:
                _state("LESS_EQUAL", writes=look in SOLID)
                gpu.state.face_culling_set("BACK" if look in SOLID else "NONE")
                _draw(drawn.front[look], look, scale)


def _draw(batch: gpu.types.GPUBatch, look: Look, scale: float) -> None:
    shader = _shader(look)
    shader.bind()
    if look.lines:
        shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
        shader.uniform_float("lineWidth", WIDTHS[look] * scale)
    batch.draw(shader)


def _state(test: str, *, writes: bool) -> None:
    gpu.state.depth_test_set(test)
    gpu.state.depth_mask_set(writes)


@contextmanager
def _own_state() -> Iterator[None]:
    blend, test = gpu.state.blend_get(), gpu.state.depth_test_get()
    writes = gpu.state.depth_mask_get()
    gpu.state.blend_set("ALPHA")
    try:
        yield
    finally:
        gpu.state.face_culling_set("NONE")
        gpu.state.blend_set(blend)
        gpu.state.depth_test_set(test)
        gpu.state.depth_mask_set(writes)
