"""The film of a result: as long as the motion, a figure that moves, and no trace in the scene."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

from hangtime.bridge.picture import film
from hangtime.bridge.picture.film import draw_film, lay_out_film
from hangtime.bridge.picture.sheet import Limb, SheetRow, View
from hangtime.solver.data.faults import OutputNotWritable

TIMES = np.linspace(2.0, 2.5, 61)


def slider(further: float) -> SheetRow:
    """A trunk that slides along x, from 0 m to `further`."""
    com = np.stack([further * (TIMES - 2.0) / 0.5, 0 * TIMES, 0.9 + 0 * TIMES], axis=1)
    turn = np.repeat(np.eye(3)[None], len(TIMES), axis=0)
    return SheetRow(
        "Slid", TIMES, (Limb("trunk", np.full(3, 0.5), com, turn),), com, np.zeros((0, 3))
    )


# Drawn and read in processes of their own, which may leave behind what they like.
LOADER = str(Path(__file__).parents[3] / "devtools" / "package.py")
DRAW = """
import os, runpy, sys
runpy.run_path(sys.argv[1])["load"]()
import bpy
from pathlib import Path
from hangtime.bridge.picture.film import draw_film
from hangtime.tests.blender.bridge.test_film import slider
kinds = ("objects", "actions", "scenes")
before = [len(getattr(bpy.data, kind)) for kind in kinds]
draw_film([slider(2.0)], Path(sys.argv[2]), width=160)
after = [len(getattr(bpy.data, kind)) for kind in kinds]
sys.stdout.flush()
os._exit(0 if after == before else 1)
"""
READ = """
import os, sys
import bpy
path, folder = sys.argv[1:]
scene = bpy.context.scene
clip = bpy.data.movieclips.load(path)
editor = scene.sequence_editor_create()
strips = editor.strips if hasattr(editor, "strips") else editor.sequences
strips.new_movie("film", path, channel=1, frame_start=1)
scene.render.resolution_x, scene.render.resolution_y = clip.size
scene.render.resolution_percentage = 100
scene.render.image_settings.file_format = "PNG"
scene.view_settings.view_transform = "Standard"
scene.frame_start, scene.frame_end = 1, clip.frame_duration
scene.render.filepath = os.path.join(folder, "frame")
bpy.ops.render.render(animation=True)
sys.stdout.flush()
os._exit(0)
"""


def frames(path: Path) -> list[np.ndarray]:
    """Every frame of a film, (H, W, 3), as Blender reads it back."""
    command = [sys.executable, "-c", READ, str(path), str(path.parent)]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    found = []
    for file in sorted(path.parent.glob("frame*.png")):
        image = bpy.data.images.load(str(file))
        wide, high = image.size
        found.append(np.array(image.pixels[:]).reshape(high, wide, -1)[::-1, :, :3])
        bpy.data.images.remove(image)
    return found


def middle_of_blue(picture: np.ndarray) -> float:
    """Where an adapted figure is, share of the picture's width."""
    blue = picture[..., 2] - picture[..., 0] > 0.25
    return float(np.nonzero(blue)[1].mean()) / picture.shape[1]


@pytest.mark.slow
def test_the_figure_moves_through_the_film_as_the_body_does_and_leaves_no_trace(tmp_path):
    command = [sys.executable, "-c", DRAW, LOADER, str(tmp_path / "film.mp4")]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    shown = frames(tmp_path / "film.mp4")
    assert len(shown) == 0.5 * film.RATE + 1
    places = [middle_of_blue(frame) for frame in shown]
    steps = np.diff(places)
    assert steps.min() > 0.0
    assert steps.max() < 1.5 * steps.mean()


def test_every_frame_has_the_instant_at_its_time():
    layout = lay_out_film([slider(2.0), slider(1.0)], View(in_place=True))
    for tier, further in zip(layout.tiers, (2.0, 1.0), strict=True):
        times = [figure.time for figure in tier.figures]
        assert times == pytest.approx(2.0 + np.arange(13) / film.RATE, abs=0.5 / 120)
        run = tier.figures[-1].com[0] - tier.figures[0].com[0]
        assert run == pytest.approx(further)


def test_a_film_that_cannot_be_written_is_told_before_it_is_drawn(tmp_path):
    with pytest.raises(OutputNotWritable):
        draw_film([slider(1.0)], tmp_path / "missing" / "film.mp4")
