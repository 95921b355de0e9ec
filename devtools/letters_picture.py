"""Draws batch/collect/letters.png anew: python3 devtools/letters_picture.py, with Blender's module.

White letters on black, in cells of equal size, in the order of contact_sheet.LETTERS: DejaVu Sans Mono,
which Blender brings along.
"""

from pathlib import Path
from runpy import run_path

import bpy

run_path(str(Path(__file__).with_name("package.py")))["load"]()

from hangtime.batch.collect.letters import (  # noqa: E402 - the package is made importable above
    ATLAS,
    COLUMNS,
    HIGH,
    LETTERS,
    WIDE,
)

EM = 17.6  # Blender's size of letters, which are 0.602 em and here 7.9 pixels wide
BASE = 4.0  # pixels from a cell's lower edge to the line that letters stand on
SAMPLES = 64


def main() -> None:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    assert scene is not None
    fonts = Path(bpy.utils.system_resource("DATAFILES")) / "fonts"
    font = bpy.data.fonts.load(str(next(fonts.glob("DejaVuSansMono*"))))
    white = bpy.data.materials.new("white")
    white.use_nodes = True
    tree = white.node_tree
    assert tree is not None
    tree.nodes.clear()
    surface = tree.nodes.new("ShaderNodeEmission")
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(surface.outputs[0], output.inputs["Surface"])
    lines = -(-len(LETTERS) // COLUMNS)
    for k, letter in enumerate(LETTERS):
        curve = bpy.data.curves.new(letter, "FONT")
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
    settings.engine = "CYCLES"
    settings.resolution_x, settings.resolution_y = WIDE * COLUMNS, HIGH * lines
    settings.filepath = str(ATLAS)
    settings.dither_intensity = 0.0
    settings.image_settings.file_format = "PNG"
    settings.image_settings.color_mode = "BW"
    settings.image_settings.compression = 100
    scene.view_settings.view_transform = "Raw"
    scene.cycles.samples, scene.cycles.use_denoising = SAMPLES, False
    scene.cycles.filter_width = 0.9
    bpy.ops.render.render(write_still=True)


if __name__ == "__main__":
    main()
