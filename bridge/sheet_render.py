"""Renders a sheet's layout in a scene of its own and removes whatever that made."""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from ..solver.recording import FloatArray
from .sheet_layout import Layout
from .sheet_scene import Painter

PAPER = np.array([247, 248, 250]) / 255  # sRGB
LIT_SAMPLES, FLAT_SAMPLES = 8, 32  # for each pixel; the denoiser mends the former


def render(layout: Layout, path: Path, width: int) -> None:
    """Render `layout` to the PNG file `path`.

    Twice: what is lit few samples and denoised; letters and lines, which a denoiser would blur,
    with more samples and no light. Both are then laid over the paper.
    """
    with _cycles(), _clean_scene() as scene, TemporaryDirectory() as folder:
        painter = Painter(scene)
        painter.draw(layout, width)
        picture = PAPER.reshape(1, 1, 3)
        for drawn, hidden in ((painter.lit, painter.flat), (painter.flat, painter.lit)):
            drawn.hide_render, hidden.hide_render = False, True
            file = Path(folder) / f"{drawn.name}.png"
            _render(scene, file, denoise=drawn is painter.lit)
            picture = _over(_read(file), picture)
        _write(picture, path)


@contextmanager
def _clean_scene() -> Iterator[Any]:
    """A new scene; every data-block that appears while it lives is removed at the end."""
    import bpy

    kinds = [p.identifier for p in bpy.data.bl_rna.properties if p.type == "COLLECTION"]
    before = {kind: set(getattr(bpy.data, kind)) for kind in kinds}
    scene = bpy.data.scenes.new("Hangtime sheet")
    try:
        yield scene
    finally:
        made = [block for kind in kinds for block in set(getattr(bpy.data, kind)) - before[kind]]
        bpy.data.batch_remove(made)


@contextmanager
def _cycles() -> Iterator[None]:
    """Cycles is enabled inside, and disabled afterwards where the user had it disabled."""
    import bpy  # noqa: F401  it makes the next import possible

    # isort: split
    import addon_utils

    _, enabled = addon_utils.check("cycles")
    if not enabled:
        addon_utils.enable("cycles")
    try:
        yield
    finally:
        if not enabled:
            addon_utils.disable("cycles")


def _render(scene: Any, path: Path, *, denoise: bool) -> None:
    import bpy

    settings = scene.render
    settings.engine = "CYCLES"
    settings.filepath = str(path)
    settings.film_transparent = True
    settings.image_settings.file_format = "PNG"
    settings.image_settings.color_mode = "RGBA"
    settings.image_settings.compression = 0
    scene.view_settings.view_transform = "Standard"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.use_light_tree = False  # one lamp
    cycles.max_bounces = 1 if denoise else 0
    cycles.use_denoising = denoise and _has_denoiser()
    cycles.denoising_prefilter = "NONE"
    cycles.denoising_quality = "FAST"
    cycles.samples = LIT_SAMPLES if cycles.use_denoising else FLAT_SAMPLES
    cycles.use_adaptive_sampling = not denoise
    cycles.adaptive_min_samples, cycles.adaptive_threshold = 4, 0.1
    with _quiet():
        bpy.ops.render.render(write_still=True, scene=scene.name)


def _read(path: Path) -> FloatArray:
    """(H, W, 4) sRGB values and alpha of an image, bottom row first."""
    import bpy

    image = bpy.data.images.load(str(path))
    wide, high = image.size
    pixels = np.empty(wide * high * 4, dtype=np.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(high, wide, 4).astype(float)


def _over(front: FloatArray, back: FloatArray) -> FloatArray:
    """(H, W, 3) an image with alpha (H, W, 4) laid over an opaque one."""
    alpha = front[..., 3:]
    return front[..., :3] * alpha + back * (1 - alpha)


def _write(picture: FloatArray, path: Path) -> None:
    import bpy

    high, wide, _ = picture.shape
    image = bpy.data.images.new("sheet", wide, high, alpha=False)
    opaque = np.concatenate([picture, np.ones((high, wide, 1))], axis=2)
    image.pixels.foreach_set(opaque.astype(np.float32).ravel())
    image.filepath_raw = str(path)
    image.file_format = "PNG"
    image.save()


@contextmanager
def _quiet() -> Iterator[None]:
    """Without a window Blender prints a line for every object it draws; not inside this."""
    import bpy

    if not bpy.app.background:
        yield
        return
    sys.stdout.flush()
    kept, nowhere = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, 1)
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)
        os.close(nowhere)


def _has_denoiser() -> bool:
    import _cycles

    return bool(_cycles.with_openimagedenoise)
