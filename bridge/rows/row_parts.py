"""What a row of the artist's lists is about: its bones, and lengths and directions in metres."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ...solver.data.faults import CrossedBounds, NoBoneChosen, NoDirection, UnknownBone
from ...solver.data.requests import Bound, Path, Vector
from .times import Clip

if TYPE_CHECKING:
    import bpy


@dataclass(frozen=True)
class RowContext:
    """Context in which rows become the solver's records.

    metres: per Blender unit; own: m per unit of the armature's own space. paths: of the points that
    follow a target, by the row's name.
    """

    armature: bpy.types.Object
    clip: Clip
    metres: float
    own: float
    paths: dict[str, Path]


def bones_of(row: Any, context: RowContext) -> tuple[str, ...]:
    """Every bone that was chosen, once. Raises UnknownBone."""
    names = dict.fromkeys(bone.name for bone in row.bones if bone.name)
    known: Any = context.armature.data
    for name in names:
        if name not in known.bones:
            raise UnknownBone(row.name, name)
    return tuple(names)


def some_bones(row: Any, context: RowContext) -> tuple[str, ...]:
    bones = bones_of(row, context)
    if not bones:
        raise NoBoneChosen(row.name)
    return bones


def bone_of(row: Any, context: RowContext) -> str:
    return some_bones(row, context)[0]


def offset_of(row: Any, context: RowContext) -> Vector | None:
    return scaled(row.offset, context.own) if row.use_offset else None


def scaled(vector: Iterable[float], by: float = 1.0) -> Vector:
    x, y, z = (by * value for value in vector)
    return x, y, z


def direction_of(row: Any, vector: Iterable[float]) -> Vector:
    direction = scaled(vector)
    if not any(direction):
        raise NoDirection(row.name)
    return direction


def ordered_bound(
    row: Any,
    low: float | None,
    high: float | None,
    unit: str = "m",
    told: Callable[[float], float] = float,
) -> Bound:
    """Both; told: as the artist reads them, in `unit`. Raises CrossedBounds."""
    if low is not None and high is not None and low > high:
        raise CrossedBounds(row.name, told(low), told(high), unit)
    return low, high
