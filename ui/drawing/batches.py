"""Batches of coloured triangles and lines on the GPU, drawn by Blender's own shaders."""

from typing import Any

import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader
from numpy.typing import NDArray

LINES = "POLYLINE_"  # what shaders of lines with a width are called


def batch(
    shader: str,
    corners: NDArray[np.float32],
    colours: NDArray[np.float32],
    faces: NDArray[np.int32] | None = None,
) -> gpu.types.GPUBatch:
    """Corners (N, 3) and their colours (N, 4) on the GPU. Only while something is drawn."""
    kind = "LINES" if shader.startswith(LINES) else "TRIS"
    content: Any = {"pos": corners, "color": colours}  # arrays are buffers; the stubs do not know
    return batch_for_shader(gpu.shader.from_builtin(shader), kind, content, indices=faces)


def draw(
    shapes: gpu.types.GPUBatch, shader: str, width: float, viewport: tuple[float, float]
) -> None:
    """Draws a batch with the shader it was made for. width: of lines; viewport: its size; px."""
    program = gpu.shader.from_builtin(shader)
    program.bind()
    if shader.startswith(LINES):
        program.uniform_float("viewportSize", viewport)
        program.uniform_float("lineWidth", width)
    shapes.draw(program)
