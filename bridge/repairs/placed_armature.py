"""Repairs of where a figure stands, how large it is, and of the scene's clock.

An empty above all that the armature hangs on turns, scales and lowers it; no key changes.
"""

from __future__ import annotations

import bpy
from mathutils import Matrix

from ...solver.doctor.repairs import Repairs, UpAxis
from ...solver.doctor.upright import turn_upright
from ..accessors import current_scene, present
from ..armature.poses import metres_per_unit
from ..properties.settings import settings_of
from .stored import applied, text_of

NAME = "Hangtime repairs"
MARK = "hangtime_repairs"  # of the empty, whatever the artist calls it


def repair(armature: bpy.types.Object, repairs: Repairs) -> None:
    """Has these repairs count instead of those before."""
    before = applied(settings_of(armature))
    current_scene().render.fps_base *= repairs.time_scale / before.time_scale
    _place(armature, repairs)
    settings_of(armature).repairs = text_of(repairs)
    present(bpy.context.view_layer).update()


def _place(armature: bpy.types.Object, repairs: Repairs) -> None:
    """Turns the figure upright, scales it about the world's origin and lowers it to the floor."""
    top = armature
    while top.parent is not None and not top.parent.get(MARK):
        top = top.parent
    above = top.parent
    if repairs.up is UpAxis.Z and repairs.scale == 1.0 and repairs.floor == 0.0:
        if above is not None:
            bpy.data.objects.remove(above)
        return
    if above is None:
        above = bpy.data.objects.new(NAME, None)
        above[MARK] = True
        present(current_scene().collection).objects.link(above)
        top.parent = above
    turn = Matrix(turn_upright(repairs.up).tolist()).to_4x4()
    lowered = Matrix.Translation((0.0, 0.0, -repairs.floor / metres_per_unit(current_scene())))
    above.matrix_world = lowered @ Matrix.Scale(repairs.scale, 4) @ turn
