"""Annotations of a picture: constraints beside the body (thesis 6). Pure data, no Blender.

World frame, m, Z up. Every array is either constant or has one axis more in front: a value for each
instant of the row that the mark belongs to (`SheetRow.times`). So a trajectory of a joint can be
given as it is, and a fixed place as one vector. `span`: the first and last instant (s) at which the
mark is shown; it is drawn with every figure in it, or alone where no figure is.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from enum import Enum
from typing import Annotated, Any, TypeVar, get_type_hints

import numpy as np

from ...solver.arrays import FloatArray, IntArray

TimeSpan = tuple[float, float]
ALWAYS: TimeSpan = (-float("inf"), float("inf"))


class Follows(Enum):
    """Transformation rule of an array: as points, directions or rotations."""

    POINT = "point"
    DIRECTION = "direction"
    ROTATION = "rotation"


@dataclass(frozen=True)
class Varying:
    """ndim: number of axes at one instant."""

    follows: Follows
    ndim: int


Point = Annotated[FloatArray, Varying(Follows.POINT, 1)]  # (3,) or (T, 3)
Points = Annotated[FloatArray, Varying(Follows.POINT, 2)]  # (N, 3) or (T, N, 3)
Direction = Annotated[FloatArray, Varying(Follows.DIRECTION, 1)]  # (3,) or (T, 3)
Rotation = Annotated[FloatArray, Varying(Follows.ROTATION, 2)]  # (3, 3) or (T, 3, 3)
Rotations = Annotated[FloatArray, Varying(Follows.ROTATION, 3)]  # (N, 3, 3) or (T, N, 3, 3)


@dataclass(frozen=True)
class Sphere:
    """A point constraint. place: (3,) m. hollow: the point is only held, no force acts there."""

    place: Point
    span: TimeSpan = ALWAYS
    hollow: bool = False


@dataclass(frozen=True)
class Cone:
    """A cone limit, drawn around the limb from its joint (thesis 3.3.3).

    apex: (3,) m, the joint. axis: (3,) unit vector. across: (3,) unit vector across the axis, along
    which the cone is stretch[0] times as wide; stretch[1] applies across both. half_angle: rad.
    length: m along the cone's side.
    """

    apex: Point
    axis: Direction
    across: Direction
    half_angle: float
    length: float
    stretch: tuple[float, float] = (1.0, 1.0)
    span: TimeSpan = ALWAYS


@dataclass(frozen=True)
class LimitArc:
    """Angle limits of a hinge, as an arc about its joint.

    centre: (3,) m. zero: (3,) unit vector, where the limb points at angle 0. normal: (3,) unit
    vector across it, about which angles count. lower, upper: rad; equal ones give one line.
    radius: m.
    """

    centre: Point
    zero: Direction
    normal: Direction
    lower: float
    upper: float
    radius: float
    span: TimeSpan = ALWAYS


@dataclass(frozen=True)
class Ghost:
    """A pose constraint: the body's boxes as it shall be, see-through.

    centre: (N, 3) m. rotation: (N, 3, 3), box to world. size: (N, 3) extents, m.
    """

    centre: Points
    rotation: Rotations
    size: FloatArray
    span: TimeSpan = ALWAYS


@dataclass(frozen=True)
class Box:
    """A carried weight. centre: (3,) m. rotation: (3, 3), box to world. size: (3,) extents, m."""

    centre: Point
    rotation: Rotation
    size: FloatArray
    span: TimeSpan = ALWAYS


@dataclass(frozen=True)
class Bar:
    """A round bar of the environment, to hang on or to clear. start, end: (3,) m. radius: m."""

    start: Point
    end: Point
    radius: float = 0.02
    span: TimeSpan = ALWAYS


@dataclass(frozen=True)
class Thing:
    """An object of the scene. points: (V, 3) m. triangles: (F, 3) their indices. wall: whether it
    is as high as the body, and so would hide what is behind it."""

    points: Points
    triangles: IntArray
    span: TimeSpan = ALWAYS
    wall: bool = False


class Tone(Enum):
    """Reason for which a limb is coloured."""

    FIXED = "fixed"  # its joint keeps its angle
    LIMP = "limp"  # the torque at its joint is limited


@dataclass(frozen=True)
class Tint:
    """Limbs in a colour of their own. limbs: names of the row's."""

    limbs: tuple[str, ...]
    tone: Tone
    span: TimeSpan = ALWAYS


Mark = Sphere | Cone | LimitArc | Ghost | Box | Bar | Thing | Tint
M = TypeVar("M", Sphere, Cone, LimitArc, Ghost, Box, Bar, Thing, Tint, Mark)


def at(mark: M, instant: int) -> M:
    """The mark at one instant (index) of its row: every array without its time axis."""
    return _with(mark, {n: a[instant] for n, how, a in _varying(mark) if a.ndim > how.ndim})


def moved(mark: M, rotation: FloatArray, shift: FloatArray) -> M:
    """The mark turned by (3, 3) about the origin and then moved by (3,) m."""

    def follow(how: Follows, a: FloatArray) -> FloatArray:
        if how is Follows.ROTATION:
            return np.asarray(rotation @ a)
        return np.asarray(a @ rotation.T + (shift if how is Follows.POINT else 0.0))

    return _with(mark, {name: follow(how.follows, a) for name, how, a in _varying(mark)})


def _with(mark: M, arrays: Mapping[str, Any]) -> M:
    return replace(mark, **arrays)


def _varying(mark: Mark) -> Iterator[tuple[str, Varying, FloatArray]]:
    for name, hint in get_type_hints(type(mark), include_extras=True).items():
        for how in getattr(hint, "__metadata__", ()):
            yield name, how, np.asarray(getattr(mark, name), dtype=float)
