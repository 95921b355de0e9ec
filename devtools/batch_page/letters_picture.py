"""Draws batch/collect/letters.png anew.

By Blender's module: `python devtools/package.py devtools.batch_page.letters_picture`. White letters
on black, in cells of equal size, in the order of LETTERS: DejaVu Sans Mono, which Blender brings.
"""

from pathlib import Path

import bpy

from ...batch.collect.letters import ATLAS, COLUMNS, HIGH, LETTERS, WIDE
from ...bridge.accessors import current_scene, present
from ...bridge.picture.materials import plain

EM = 17.6  # Blender's size of letters, which are 0.602 em and here 7.9 pixels wide
BASE = 4.0  # pixels from a cell's lower edge to the line that letters stand on
SAMPLES = 64


def main(_: list[str]) -> int:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = current_scene()
    # the stubs lack it
    fonts = Path(bpy.utils.system_resource("DATAFILES")) / "fonts"  # type: ignore[attr-defined]
    font = bpy.data.fonts.load(str(next(fonts.glob("DejaVuSansMono*"))))
    white = plain()
    lines = -(-len(LETTERS) // COLUMNS)
    for k, letter in enumerate(LETTERS):
        curve = bpy.data.curves.new(letter, "FONT")
        assert isinstance(curve, bpy.types.TextCurve)
        curve.body, curve.font, curve.size = letter, font, EM
        curve.materials.append(white)
        made = bpy.data.objects.new(letter, curve)
        line, column = divmod(k, COLUMNS)
        made.location = (WIDE * column, HIGH * (lines - 1 - line) + BASE, 0.0)
        scene.collection.objects.link(made)
    camera = bpy.data.cameras.new("camera")
    camera.type, camera.sensor_fit = "ORTHO", "HORIZONTAL"
    camera.ortho_scale = WIDE * COLUMNS
    scene.camera = bpy.data.objects.new("camera", camera)
    scene.camera.location = (WIDE * COLUMNS / 2, HIGH * lines / 2, 10.0)
    scene.collection.objects.link(scene.camera)
    settings = scene.render
    settings.engine = "CYCLES"  # type: ignore[assignment]  # the stubs know no add-on's engine
    settings.resolution_x, settings.resolution_y = WIDE * COLUMNS, HIGH * lines
    settings.filepath = str(ATLAS)
    settings.dither_intensity = 0.0
    settings.image_settings.file_format = "PNG"
    settings.image_settings.color_mode = "BW"
    settings.image_settings.compression = 100
    # the stubs know no configuration of colours
    present(scene.view_settings).view_transform = "Raw"  # type: ignore[assignment]
    cycles = present(scene.cycles)
    cycles.samples, cycles.use_denoising, cycles.filter_width = SAMPLES, False, 0.9
    bpy.ops.render.render(write_still=True)
    return 0
