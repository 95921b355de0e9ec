"""Shapes as arrays of triangles and lines with colours: numpy only."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from enum import Enum, auto
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ....bridge.shapes.limits import directions
from ....solver.arrays import FloatArray, IntArray
from ...drawing.sketch import Colour

Points = NDArray[np.float32]
Faces = NDArray[np.int32]

LIGHT = np.array([0.32, -0.48, 0.82])  # towards the lamp, world
AMBIENT, AIRY = 0.55, 0.75  # share of a colour that is there without the lamp; of ghosts
RING_AROUND = 16  # lines of a ring


class Look(Enum):
    """Render style of a shape; one batch each."""

    SOLID = auto()  # triangles that hide what is behind them
    THIN = auto()  # lines
    BOLD = auto()  # thicker lines
    GLASS = auto()  # triangles that one sees through
    GHOST = auto()  # triangles that one sees through, but whose own backs one does not see

    @property
    def lines(self) -> bool:
        return self in (Look.THIN, Look.BOLD)


class Standing(float, Enum):
    """Opacity by when something counts: at the frame that is shown, at others, or not at all."""

    NOW = 1.0
    LATER = 0.4  # at other frames
    OFF = 0.0  # it is switched off


@dataclass(frozen=True)
class Shape:
    """Triangles or lines. points: (N, 3). colours: (N, 4).

    faces: (F, 3) indices, counter-clockwise from outside; of lines none: two points make one.
    """

    look: Look
    points: Points
    colours: Points
    faces: Faces | None = None


@dataclass(frozen=True)
class Label:
    """Words beside a place (3,)."""

    words: str
    place: tuple[float, float, float]
    colour: Colour


def triangles_of(faces: IntArray) -> Faces:
    """(2 F, 3) triangles of quadrilaterals (F, 4)."""
    return faces[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3).astype(np.int32)


def merged(shapes: Iterable[Shape]) -> tuple[Shape, ...]:
    """One shape for each look; empty ones are left out."""
    by_look: dict[Look, list[Shape]] = {}
    for shape in shapes:
        if len(shape.points):
            by_look.setdefault(shape.look, []).append(shape)
    return tuple(_joined(look, same) for look, same in by_look.items())


def _joined(look: Look, same: Sequence[Shape]) -> Shape:
    # the graphics card wants rows one after the other, which broadcast ones are not
    points = np.ascontiguousarray(np.concatenate([s.points for s in same]))
    colours = np.ascontiguousarray(np.concatenate([s.colours for s in same]))
    if look.lines:
        return Shape(look, points, colours)
    first = np.cumsum([0, *(len(s.points) for s in same[:-1])])
    faces = [s.faces + n for s, n in zip(same, first, strict=True) if s.faces is not None]
    return Shape(look, points, colours, np.concatenate(faces).astype(np.int32))


def placed(shape: Shape, axes: FloatArray, origin: FloatArray) -> Shape:
    """A shape that was given along x, y and z, along the columns of axes (3, 3) about a point."""
    return replace(shape, points=(shape.points @ axes.T + origin).astype(np.float32))


def faded(colour: Colour, share: float) -> Colour:
    """A colour that is seen through more."""
    return (*colour[:3], colour[3] * share)


def shades(normals: ArrayLike, ambient: float = AMBIENT) -> FloatArray:
    """(...,) how bright surfaces with unit normals (..., 3) are, lit from above."""
    n = np.asarray(normals, dtype=float)
    return np.asarray(ambient + (1.0 - ambient) * (0.5 + 0.5 * n @ LIGHT))


def painted(colours: ArrayLike, shade: FloatArray) -> Points:
    """(N, V, 4) colours, one (4,) or (N, 4), on V corners each. shade: (V,) or (N, V)."""
    full = np.asarray(colours, dtype=float).reshape(-1, 1, 4)
    lit = np.ones((*shade.shape, 4))
    lit[..., :3] = shade[..., None]
    return (full * lit).astype(np.float32)


def lines(pairs: ArrayLike, colours: ArrayLike, look: Look = Look.THIN) -> Shape:
    """Separate lines, (N, 2, 3), in one colour or in one each (N, 4)."""
    points = np.asarray(pairs, np.float32).reshape(-1, 3)
    shape = (len(points) // 2, 2, 4)
    each = np.broadcast_to(np.asarray(colours, np.float32).reshape(-1, 1, 4), shape)
    return Shape(look, points, each.reshape(-1, 4))


def polyline(points: ArrayLike, colour: ArrayLike, look: Look = Look.THIN) -> Shape:
    """A line through (N, 3) points."""
    p = np.asarray(points, np.float32)
    return lines(np.stack([p[:-1], p[1:]], axis=1), colour, look)


def dashed(points: ArrayLike, colour: ArrayLike, *, dash: float, gap: float, look: Look) -> Shape:
    """A line through (N, 3) points in dashes, measured along it."""
    p = np.asarray(points, dtype=float)
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(p, axis=0), axis=1))])
    if len(p) < 2 or not along[-1] > 0.0:
        return lines(np.zeros((0, 2, 3)), colour, look)
    starts = np.arange(0.0, along[-1], dash + gap)
    ends = np.minimum(starts + dash, along[-1])
    # cut at the corners as well, so that a dash bends with the line
    cuts = np.unique(np.concatenate([starts, ends, along]))
    middles = 0.5 * (cuts[:-1] + cuts[1:])
    drawn = middles % (dash + gap) < dash
    at = np.stack([np.interp(cuts, along, p[:, k]) for k in range(3)], axis=1)
    return lines(np.stack([at[:-1], at[1:]], axis=1)[drawn], colour, look)


def dotted(starts: ArrayLike, ends: ArrayLike, colours: ArrayLike, dashes: int = 7) -> Shape:
    """Straight lines between (N, 3) points, each in so many dashes."""
    a, b = np.asarray(starts, dtype=float)[:, None, None], np.asarray(ends, dtype=float)
    share = (np.arange(2 * dashes) / (2 * dashes - 1)).reshape(1, dashes, 2, 1)
    pairs = a + share * (b[:, None, None] - a)
    each = np.repeat(np.asarray(colours, dtype=float).reshape(-1, 4), dashes, axis=0)
    return lines(pairs.reshape(-1, 2, 3), each)


def rings(
    centres: ArrayLike, radii: ArrayLike, colours: ArrayLike, look: Look = Look.THIN
) -> Shape:
    """Hollow balls: three circles about each of (N, 3) centres; radii and colours one or N."""
    c = np.asarray(centres, dtype=float).reshape(-1, 1, 3)
    r = np.broadcast_to(np.asarray(radii, dtype=float).reshape(-1, 1, 1), (len(c), 1, 1))
    points = (c + r * _circles()).reshape(-1, 2, 3)
    each = np.asarray(colours, dtype=float).reshape(-1, 4)
    return lines(points, np.repeat(each, 3 * RING_AROUND, axis=0) if len(each) > 1 else each, look)


@lru_cache(maxsize=1)
def _circles() -> FloatArray:
    """(3 * RING_AROUND * 2, 3) lines of three unit circles."""
    flat = directions(np.linspace(0.0, 2 * np.pi, RING_AROUND + 1))
    circles = np.stack([flat, flat[:, [2, 0, 1]], flat[:, [1, 2, 0]]])
    return np.asarray(np.stack([circles[:, :-1], circles[:, 1:]], axis=2).reshape(-1, 3))
