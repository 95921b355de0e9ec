"""Human joint limits as rows of an armature's list, and whether its recording keeps to them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import degrees, radians

import bpy
import numpy as np

from ...solver.body.human_limits import (
    ConeRange,
    JointRange,
    human_ranges,
    limit_violation,
    missing_joints,
)
from ..constraint_kinds import cone, joint_limit
from ..properties.settings import settings_of
from .rest_figure import directions, parts_of, recorded_looks, rest_figure, rest_rotations
from .rows import add_constraint, free_name, hold_throughout

NOTICED = radians(1.0)


@dataclass(frozen=True)
class JointLimits:
    """What was added. made: names of the rows. missing: joints without a bone. beyond: by how much,
    rad, the recording leaves a row at worst. checked: whether there was a recording to ask."""

    made: tuple[str, ...]
    missing: tuple[str, ...]
    beyond: Mapping[str, float]
    checked: bool


def joint_limits(armature: bpy.types.Object) -> JointLimits:
    """Adds a row for each joint of the table that the armature has bones for.

    A row that the recording does not keep to says so in its status; it is no wider for it.
    """
    looks = recorded_looks(armature)
    world = np.array(armature.matrix_world, float) if looks is None else looks.object_to_world[0]
    figure = rest_figure(armature, parts_of(armature), world)
    if figure is None:
        return JointLimits((), (), {}, checked=False)
    seen = directions(looks, figure, rest_rotations(armature)) if looks is not None else {}
    made: dict[str, float] = {}
    for limit in human_ranges(figure):
        name = _add(armature, limit)
        by = limit_violation(limit, seen[limit.bone], figure) if limit.bone in seen else 0.0
        made[name] = by
        if by > NOTICED:
            row = settings_of(armature).constraints[-1]
            row.status = f"The recording goes {degrees(by):.0f}° beyond"
    return JointLimits(tuple(made), missing_joints(figure), made, checked=looks is not None)


def _add(armature: bpy.types.Object, limit: JointRange) -> str:
    kind = (cone if isinstance(limit, ConeRange) else joint_limit).KIND
    row = add_constraint(armature, kind, [limit.bone], 0.0)
    row.name = free_name(settings_of(armature), limit.name)
    hold_throughout(row)
    if isinstance(limit, ConeRange):
        row.half_angle = limit.half_angle
        row.use_axis, row.axis = True, limit.axis.tolist()
        row.stretch = limit.stretch
    else:
        row.use_lower, row.lower = True, limit.lower
        row.use_upper, row.upper = True, limit.upper
    return str(row.name)
