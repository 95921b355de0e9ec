"""Rendering of a sheet's layout by Cycles, in a scene of its own that is removed afterwards."""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import bpy  # first, for it makes the next one importable

# isort: split
import addon_utils

from ..accessors import present
from .layout import Layout
from .scene import Painter
from .sheet import View

SAMPLES, BARE_SAMPLES = 6, 32  # for each pixel, with and without a denoiser
SEEN_THROUGH = 64  # surfaces behind each other: two for each box of a see-through body


def render(layout: Layout, view: View, path: Path, width: int) -> None:
    """Render `layout` to the PNG file `path`."""
    with _cycles(), _clean_scene() as scene:
        Painter(scene, view.elevation).draw(layout, width)
        _render(scene, path)


@contextmanager
def _clean_scene() -> Iterator[bpy.types.Scene]:
    """A new scene; every data-block that appears while it lives is removed at the end."""
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
    _, enabled = addon_utils.check("cycles")
    if not enabled:
        addon_utils.enable("cycles")
    try:
        yield
    finally:
        if not enabled:
            addon_utils.disable("cycles")


def _render(scene: bpy.types.Scene, path: Path) -> None:
    settings = scene.render
    settings.engine = "CYCLES"  # type: ignore[assignment]  # the stubs know no add-on's engine
    settings.filepath = str(path)
    settings.use_file_extension = False
    settings.dither_intensity = 0.0  # noise that would triple the file
    settings.image_settings.file_format = "PNG"
    settings.image_settings.color_mode = "RGB"
    settings.image_settings.compression = 50
    # the stubs know no configuration of colours
    present(scene.view_settings).view_transform = "Standard"  # type: ignore[assignment]
    cycles = present(scene.cycles)
    cycles.device = "CPU"
    cycles.use_light_tree = False  # one lamp
    cycles.max_bounces = 1
    cycles.transparent_max_bounces = SEEN_THROUGH
    cycles.use_denoising = _has_denoiser()
    # Told colours and normals too, the denoiser keeps edges as jagged as few samples leave them.
    cycles.denoising_input_passes = "RGB"
    cycles.denoising_quality = "FAST"
    cycles.samples = SAMPLES if cycles.use_denoising else BARE_SAMPLES
    cycles.use_adaptive_sampling = False
    with _quiet():
        bpy.ops.render.render(write_still=True, scene=scene.name)


@contextmanager
def _quiet() -> Iterator[None]:
    """Without a window Blender prints a line for every object it draws; not inside this."""
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
    import _cycles  # only where Blender was built with it

    return bool(_cycles.with_openimagedenoise)
