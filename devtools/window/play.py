"""What an artist does with Hangtime, from a recording to an export, by mouse and keys.

Runs in a Blender with a window, in which the extension was installed from its zip. Each scene acts
as a person would and then says what must be true.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path

import bpy

from . import scenes, scenes_feel, scenes_solve
from .acts import PACKAGE
from .eyes import Eyes
from .gauge import Gauge
from .hands import Hands
from .stage import Scene, Stage, perform, run

OUT = Path("/mnt/out")
SCENES = (
    *scenes.SCENES,
    *scenes_feel.SCENES,
    *scenes_solve.SCENES,
    *scenes.LAST,
    *scenes_solve.LAST,
)


def start() -> None:
    """Begin the play once Blender's window is there; Blender is quit at its end."""
    preferences = bpy.context.preferences
    preferences.view.show_splash = False
    preferences.system.viewport_aa = "OFF"  # drawn once; the others draw again and again
    preferences.view.filebrowser_display_type = "SCREEN"  # the dialog in the window that is there
    ending = ExitStack()
    hands = ending.enter_context(Hands())
    stage = Stage(OUT, hands, Eyes(hands), Gauge(PACKAGE))
    ending.callback(bpy.ops.wm.quit_blender)
    ending.callback(stage.keep)
    run(perform(stage, chosen(os.environ.get("SCENES", "").split())), ending.close)


def chosen(names: Sequence[str]) -> list[Scene]:
    """The scenes of those names and whatever they need, in order; all where no name is given."""
    wanted = set(names) or {scene.name for scene in SCENES}
    for scene in reversed(SCENES):
        if scene.name in wanted:
            wanted.update(scene.needs)
    return [scene for scene in SCENES if scene.name in wanted]
