"""What a row of the artist's lists is about: its bones, and lengths and directions in metres."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy

from ...solver.data.faults import NoBoneChosen, NoDirection, UnknownBone
from ...solver.data.requests import Vector
from .times import Clip

if TYPE_CHECKING:
    from ...solver.data.requests import Path
    from ..properties.body_change import HangtimeBodyChange
    from ..properties.constraint import HangtimeConstraint


@dataclass(frozen=True)
class RowContext:
    """What rows are understood in. metres: per Blender unit; own: m per unit of the armature's own
    space. paths: of the points that follow a target, by the row's name."""

    armature: bpy.types.Object
    clip: Clip
    metres: float
    own: float
    paths: dict[str, Path]


def bones_of(row: HangtimeConstraint | HangtimeBodyChange, scene: RowContext) -> tuple[str, ...]:
    """Every bone that was chosen, once. Raises UnknownBone."""
    names = dict.fromkeys(bone.name for bone in row.bones if bone.name)
    for name in names:
        if name not in scene.armature.data.bones:
            raise UnknownBone(row.name, name)
    return tuple(names)


def some_bones(row: HangtimeConstraint | HangtimeBodyChange, scene: RowContext) -> tuple[str, ...]:
    bones = bones_of(row, scene)
    if not bones:
        raise NoBoneChosen(row.name)
    return bones


def bone_of(row: HangtimeConstraint | HangtimeBodyChange, scene: RowContext) -> str:
    return some_bones(row, scene)[0]


def offset_of(row: HangtimeConstraint | HangtimeBodyChange, scene: RowContext) -> Vector | None:
    return scaled(row.offset, scene.own) if row.use_offset else None


def scaled(vector: Iterable[float], by: float = 1.0) -> Vector:
    x, y, z = (by * value for value in vector)
    return x, y, z


def direction_of(row: HangtimeConstraint, vector: Iterable[float]) -> Vector:
    direction = scaled(vector)
    if not any(direction):
        raise NoDirection(row.name)
    return direction
