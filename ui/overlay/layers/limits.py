"""Cones around limbs, arcs at joints and about bones, as they are given and where the bones are."""

from collections.abc import Iterator

import bpy
import numpy as np
from mathutils import Vector

from ....bridge.accessors import pose_of
from ....bridge.properties.constraint import HangtimeConstraint
from ....bridge.rows.choices import Met
from ....operators.lists.row_lists import is_selected
from ..context.figure_cache import FigureCache, parent_of
from ..context.layer import Layer, Part, xyz
from ..context.view_context import ViewContext, holds, posed_bones
from ..geometry.limit_shapes import ANGLE, CONE, TWIST, Limit, Pose, limit_shapes
from ..geometry.shapes import Label, Shape, Standing

KINDS = (CONE, ANGLE, TWIST)


def layer(view: ViewContext, figures: FigureCache) -> Layer:
    """All limits, in the armature's space."""
    rows = [each for each in view.rows(*KINDS) if _matters(view, *each)]
    limits = tuple(limit for row, chosen in rows for limit in _limit(view, row, chosen))
    shown = view.recorded
    pose = posed_bones(view.armature).tobytes() if limits else b""
    content = limits, pose, shown.key if shown is not None else None

    def build() -> Iterator[Shape | Label]:
        if limits:
            yield from limit_shapes(
                limits, figures.of(view, shown), limit_pose(view.armature, limits)
            )

    return Layer(Part.LIMITS, content, build, view.armature.matrix_world.copy().freeze())


def _matters(view: ViewContext, row: HangtimeConstraint, chosen: bool) -> bool:
    """Whether a limit is drawn: a preset has eighteen, which would cover the body."""
    if view.options.all_limits or chosen or row.met == Met.MISSED.name:
        return True
    if view.armature.mode != "POSE":  # before the bone, which takes longer to find
        return False
    bone = view.bone(row)
    return bone is not None and is_selected(bone)


def chosen_limit(view: ViewContext) -> Limit | None:
    """The limit that is chosen in the list; None where it is another kind, or not about a bone."""
    chosen = (row for row, chosen in view.rows(*KINDS) if chosen)
    return next((limit for row in chosen for limit in _limit(view, row, True)), None)


def _limit(view: ViewContext, row: HangtimeConstraint, chosen: bool) -> Iterator[Limit]:
    bone = view.bone(row)
    parent = _parent(view, bone) if bone is not None else None
    if bone is None or parent is None or not (row.used or chosen):
        return
    span = view.span(row)
    standing = Standing.NOW if holds(span, view.recorded_frame) else Standing.LATER
    cone = row.kind == CONE
    yield Limit(
        kind=row.kind,
        bone=bone.name,
        parent_bone=parent.name,
        span=span,
        standing=standing if row.used else Standing.OFF,
        chosen=chosen,
        length=bone.length,
        lower=row.lower if row.use_lower and not cone else None,
        upper=row.half_angle if cone else row.upper if row.use_upper else None,
        axis=_own_axis(view, row) if cone and row.use_axis else None,
        stretch=tuple(row.stretch) if cone else (1.0, 1.0),
    )


def _parent(view: ViewContext, bone: bpy.types.PoseBone) -> bpy.types.PoseBone | None:
    shown = view.recorded
    if shown is not None and bone.name in shown.traces.bones:
        return parent_of(bone, shown.traces)
    return bone.parent


def _own_axis(view: ViewContext, row: HangtimeConstraint) -> tuple[float, float, float]:
    """In the armature's space."""
    turn = view.armature.matrix_world.to_quaternion().inverted()
    return xyz(turn @ Vector(row.axis))


def limit_pose(armature: bpy.types.Object, limits: tuple[Limit, ...]) -> Pose:
    """The bones that limits are about."""
    # Blender stores columns, numpy rows
    posed = posed_bones(armature).reshape(-1, 4, 4).transpose(0, 2, 1).astype(float)
    bones = pose_of(armature).bones
    names = {name for limit in limits for name in (limit.bone, limit.parent_bone)}
    return Pose(
        {name: posed[bones.find(name)] for name in names},
        {name: np.array(bones[name].bone.matrix_local, float) for name in names},
    )
