"""Cones around limbs, arcs at joints and about bones, as they are given and where the bones are."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import bpy
import numpy as np
from mathutils import Vector

from ..context.figure_cache import Figures, parent_of
from ..context.layer import Layer, Part
from ..context.view_context import Seen, holds
from ..geometry.limit_shapes import ANGLE, CONE, TWIST, Limit, Pose, limit_shapes
from ..geometry.shapes import Label, Shape, Standing

if TYPE_CHECKING:
    from ....bridge.properties.constraint import HangtimeConstraint


def layer(seen: Seen, figures: Figures) -> Layer:
    """All limits, in the armature's space."""
    rows = seen.rows(CONE, ANGLE, TWIST)
    limits = tuple(limit for row, chosen in rows for limit in _limit(seen, row, chosen))
    shown = seen.recorded
    pose = _posed(seen.armature).tobytes() if limits else b""
    content = limits, pose, shown.key if shown is not None else None

    def build() -> Iterator[Shape | Label]:
        if limits:
            yield from limit_shapes(limits, figures.of(seen, shown), pose_of(seen.armature, limits))

    return Layer(Part.LIMITS, content, build, seen.armature.matrix_world.copy().freeze())


def chosen_limit(seen: Seen) -> Limit | None:
    """The limit that is chosen in the list; None where it is another kind, or not about a bone."""
    rows = (row for row, chosen in seen.rows(CONE, ANGLE, TWIST) if chosen)
    return next((limit for row in rows for limit in _limit(seen, row, True)), None)


def _limit(seen: Seen, row: HangtimeConstraint, chosen: bool) -> Iterator[Limit]:
    bone = seen.bone(row)
    parent = _parent(seen, bone) if bone is not None else None
    if bone is None or parent is None or not (row.used or chosen):
        return
    span = seen.span(row)
    standing = Standing.NOW if holds(span, seen.frame) else Standing.LATER
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
        axis=_own_axis(seen, row) if cone and row.use_axis else None,
        stretch=tuple(row.stretch) if cone else (1.0, 1.0),
    )


def _parent(seen: Seen, bone: bpy.types.PoseBone) -> bpy.types.PoseBone | None:
    shown = seen.recorded
    if shown is not None and bone.name in shown.traces.bones:
        return parent_of(bone, shown.traces)
    return bone.parent


def _own_axis(seen: Seen, row: HangtimeConstraint) -> tuple[float, float, float]:
    """In the armature's space."""
    turn = seen.armature.matrix_world.to_quaternion().inverted()
    return tuple(turn @ Vector(row.axis))


def _posed(armature: bpy.types.Object) -> np.ndarray:
    """(N * 16,) all bones' matrices, as Blender stores them."""
    flat = np.empty(16 * len(armature.pose.bones), np.float32)
    armature.pose.bones.foreach_get("matrix", flat)
    return flat


def pose_of(armature: bpy.types.Object, limits: tuple[Limit, ...]) -> Pose:
    """The bones that limits are about."""
    # Blender stores columns, numpy rows
    posed = _posed(armature).reshape(-1, 4, 4).transpose(0, 2, 1).astype(float)
    bones = armature.pose.bones
    names = {name for limit in limits for name in (limit.bone, limit.parent_bone)}
    return Pose(
        {name: posed[bones.find(name)] for name in names},
        {name: np.array(bones[name].bone.matrix_local) for name in names},
    )
