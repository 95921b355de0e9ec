"""Repairs of where a figure stands and how large it is: an empty above all that it hangs on."""

from __future__ import annotations

import bpy
from mathutils import Matrix

from ...solver.doctor.repairs import Repairs, UpAxis
from ...solver.doctor.upright import turn_upright
from ..accessors import current_scene, present
from ..armature.poses import metres_per_unit

NAME = "Hangtime repairs"


def place_armature(armature: bpy.types.Object, repairs: Repairs) -> None:
    """Turns the figure upright, scales it about the world's origin and lowers it to the floor.

    No key changes. A scene whose clock is wrong gets another frame rate.
    """
    render = current_scene().render
    render.fps_base *= repairs.time_scale
    if repairs.up is UpAxis.Z and repairs.scale == 1.0 and repairs.floor == 0.0:
        return
    top = armature
    while top.parent is not None:
        top = top.parent
    above = bpy.data.objects.new(NAME, None)
    present(current_scene().collection).objects.link(above)
    turn = Matrix(turn_upright(repairs.up).tolist()).to_4x4()
    lowered = Matrix.Translation((0.0, 0.0, -repairs.floor / metres_per_unit(current_scene())))
    above.matrix_world = lowered @ Matrix.Scale(repairs.scale, 4) @ turn
    top.parent = above
    present(bpy.context.view_layer).update()
