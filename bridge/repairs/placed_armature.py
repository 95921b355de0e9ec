"""Repairs of where a figure stands, how large it is, of the scene's clock and of missing frames.

An empty above all that the armature hangs on, and no other does, turns, scales and lowers it, and
frames are put into a copy: no key changes.
"""

from __future__ import annotations

import bpy
from mathutils import Matrix

from ...solver.doctor.repairs import Repairs
from ...solver.doctor.upright import turn_upright
from ..accessors import current_scene, present
from ..armature.poses import frames_per_second, metres_per_unit, set_frame_rate
from ..properties.settings import settings_of
from ..scene.support_box import carry_along
from .missing_keys import put_in
from .stored import applied, text_of

NAME = "Hangtime repairs"
MARK = "hangtime_repairs"  # of the empty, whatever the artist calls it


def repair(armature: bpy.types.Object, repairs: Repairs) -> None:
    """Has these repairs count instead of those before. Raises NotPutIn, NotBetweenFrames."""
    before = applied(settings_of(armature))
    if repairs.missing != before.missing:
        put_in(armature, repairs.missing, before.missing)
    if repairs.time_scale != before.time_scale:
        unrepaired = frames_per_second(current_scene()) * before.time_scale
        set_frame_rate(current_scene(), unrepaired / repairs.time_scale)
    _place(armature, repairs)
    settings_of(armature).repairs = text_of(repairs)
    present(bpy.context.view_layer).update()


def _place(armature: bpy.types.Object, repairs: Repairs) -> None:
    """Turns the figure upright, and its floor level, scales it about the world's origin and lowers
    it to the floor; and with it boxes that were added to carry it."""
    top = _top(armature)
    above = top.parent if _is_ours(top.parent) else None
    before = Matrix() if above is None else above.matrix_basis.copy()
    placement = _placement(repairs)
    carry_along(armature, placement @ before.inverted())
    if not repairs.places:
        if above is not None:
            top.parent = _followed(above)
            bpy.data.objects.remove(above)
        return
    if above is None:
        above = _put_above(top)
    above.matrix_basis = placement


def _placement(repairs: Repairs) -> Matrix:
    """Of the empty."""
    turn = Matrix(turn_upright(repairs).tolist()).to_4x4()
    lowered = Matrix.Translation((0.0, 0.0, -repairs.floor / metres_per_unit(current_scene())))
    return lowered @ Matrix.Scale(repairs.scale, 4) @ turn


def _top(armature: bpy.types.Object) -> bpy.types.Object:
    """What the empty is, or is to be, above: the highest thing on which no other armature hangs."""
    line = [armature]
    while line[-1].parent is not None:
        line.append(line[-1].parent)
    if applied(settings_of(armature)).places:
        for thing in line:
            if _is_ours(thing.parent):
                return thing
    top = armature
    for thing in line[1:]:
        own = top.parent_type != "OBJECT" or not _carries_others(thing, armature)
        if _is_ours(thing) or not own:
            break
        top = thing
    return top


def _carries_others(thing: bpy.types.Object, armature: bpy.types.Object) -> bool:
    """Whether another armature hangs on a thing, by an empty of ours, too, or it is one."""
    each = [thing, *thing.children_recursive]
    followed = {_followed(one) for one in bpy.data.objects if _is_ours(one)}
    return any((one.type == "ARMATURE" and one != armature) or one in followed for one in each)


def _is_ours(thing: bpy.types.Object | None) -> bool:
    return thing is not None and bool(thing.get(MARK))


def _put_above(top: bpy.types.Object) -> bpy.types.Object:
    """An empty of which a thing hangs instead of its parent, whose movement the empty follows in
    the world as it turns and scales it."""
    above = bpy.data.objects.new(NAME, None)
    above[MARK] = True
    present(current_scene().collection).objects.link(above)
    if top.parent is not None:
        follow = above.constraints.new("COPY_TRANSFORMS")
        assert isinstance(follow, bpy.types.CopyTransformsConstraint)
        follow.target, follow.mix_mode = top.parent, "AFTER_FULL"
    top.parent = above
    return above


def _followed(above: bpy.types.Object) -> bpy.types.Object | None:
    """The parent in whose place an empty is."""
    constraints = [
        each for each in above.constraints if isinstance(each, bpy.types.CopyTransformsConstraint)
    ]
    return constraints[0].target if constraints else None
