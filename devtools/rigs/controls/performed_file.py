"""File with Rigify's generated human, feet in IK, and a recorded jump on its controls.

Made in the sandbox's Blender, which has Rigify, from the checkout; the window then opens the file.
"""

from pathlib import Path

import bpy

from ....bridge.accessors import present
from ..generated import generated_human, perform
from .cases import RATE, performer

NAME = "Rigify"


def main(argv: list[str]) -> int:
    """Write the file; argv: its path."""
    actor = performer()
    rig = generated_human(actor, arms=1.0, legs=0.0)
    rig.name = NAME
    present(bpy.context.scene).render.fps = RATE
    perform(rig, actor)
    present(bpy.context.view_layer).objects.active = rig
    rig.select_set(True)
    bpy.ops.wm.save_as_mainfile(filepath=str(Path(argv[0])))
    return 0
