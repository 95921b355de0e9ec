"""Rendering of a sheet's layout by Cycles, in a scene of its own that is removed afterwards."""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from math import sqrt
from pathlib import Path

import bpy

from ..accessors import present
from ..addons import addon_enabled
from .film_scene import FilmPainter
from .layout import Layout
from .scene import Painter
from .sheet import View

SAMPLES, BARE_SAMPLES = 6, 32  # for each pixel, with and without a denoiser
FILM_SAMPLES = 4
SEEN_THROUGH = 64  # surfaces behind each other: two for each box of a see-through body


def render(layout: Layout, view: View, path: Path, width: int) -> None:
    """Render `layout` to the PNG file `path`."""
    with addon_enabled("cycles"), _clean_scene() as scene:
        Painter(scene, view.elevation).draw(layout, width, above=view.above)
        _render(scene, path)


def render_film(layout: Layout, view: View, path: Path, width: int, rate: int) -> None:
    """Render `layout`, a figure of each tier a frame, to the MPEG-4 file `path`; rate: frames/s."""
    with addon_enabled("cycles"), _clean_scene() as scene:
        FilmPainter(scene, view.elevation).draw(layout, width)
        scene.frame_start, scene.frame_end = 1, max(len(tier.figures) for tier in layout.tiers)
        scene.render.fps = rate
        scene.render.use_persistent_data = True  # only the figures change from frame to frame
        _choose_render(scene, path)
        _choose_encoder(scene)
        cycles = present(scene.cycles)
        cycles.use_denoising, cycles.samples = False, FILM_SAMPLES  # nothing is lit, see `shaded`
        cycles.max_bounces = 0
        try:
            with _quiet():
                bpy.ops.render.render(animation=True, scene=scene.name)
        finally:  # what the renderer keeps, and keys, would outlive what they are of
            scene.render.use_persistent_data = False
            for each in scene.objects:
                each.animation_data_clear()


def _choose_encoder(scene: bpy.types.Scene) -> None:
    """H.264 in MPEG-4, which every browser plays."""
    settings = scene.render
    if bpy.app.version >= (5, 0):
        settings.image_settings.media_type = "VIDEO"  # type: ignore[attr-defined]
    settings.image_settings.file_format = "FFMPEG"
    encoder = present(settings.ffmpeg)
    encoder.format, encoder.codec = "MPEG4", "H264"
    encoder.constant_rate_factor, encoder.ffmpeg_preset = "MEDIUM", "GOOD"
    encoder.audio_codec = "NONE"
    smaller = min(1.0, sqrt(settings.resolution_x / settings.resolution_y))  # of one that is high
    settings.resolution_x = 2 * round(settings.resolution_x * smaller / 2)  # even, as it wants them
    settings.resolution_y = 2 * round(settings.resolution_y * smaller / 2)


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


def _render(scene: bpy.types.Scene, path: Path) -> None:
    _choose_render(scene, path)
    with _quiet():
        bpy.ops.render.render(write_still=True, scene=scene.name)


def _choose_render(scene: bpy.types.Scene, path: Path) -> None:
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
