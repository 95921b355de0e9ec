"""Balls, arrows and bodies as shaded triangles: numpy only.

Each kind has one template, of which many are made at once.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from .shapes import AIRY, Faces, FloatArray, Look, Points, Shape, painted, shades

AROUND, ALONG = 12, 7  # faces of a ball
SIDES = 10  # of an arrow
TIP_LONG, TIP_WIDE = 4.5, 2.6  # an arrow's tip, in radii of its shaft
TIP_MOST = 0.6  # of a short arrow is tip
WAIST, WIDTH = 0.18, 0.11  # where a body is widest, and how wide there, in shares of its length
THICK, THIN = 0.055, 0.012  # m at most and least, half a body's width, of a figure of usual size
BODY_SIDES = 6
SHORTEST = 1e-6  # what is shorter has no direction


def none(look: Look = Look.SOLID) -> Shape:
    """Nothing to be drawn."""
    return Shape(look, np.zeros((0, 3), np.float32), np.zeros((0, 4), np.float32))


def balls(centres: ArrayLike, radii: ArrayLike, colours: ArrayLike) -> Shape:
    """Balls about (N, 3) centres; radii and colours one or N."""
    c = np.asarray(centres, dtype=float).reshape(-1, 1, 3)
    if not len(c):
        return none()
    unit, faces = _unit_ball()
    points = c + np.asarray(radii, dtype=float).reshape(-1, 1, 1) * unit
    return _many(Look.SOLID, points, painted(colours, shades(unit)), faces)


@lru_cache(maxsize=1)
def _unit_ball() -> tuple[FloatArray, Faces]:
    up, turn = np.linspace(-np.pi / 2, np.pi / 2, ALONG + 1), np.linspace(0, 2 * np.pi, AROUND + 1)
    u, t = np.meshgrid(up, turn, indexing="ij")
    grid = np.stack([np.cos(u) * np.cos(t), np.cos(u) * np.sin(t), np.sin(u)], axis=-1)
    return grid.reshape(-1, 3), _sheet(ALONG + 1, AROUND + 1)


def _sheet(rows: int, columns: int) -> Faces:
    """Triangles of a grid of corners."""
    i, j = np.meshgrid(np.arange(rows - 1), np.arange(columns - 1), indexing="ij")
    a = (i * columns + j).reshape(-1, 1)
    quads = np.concatenate([a, a + 1, a + columns + 1, a + columns], axis=1)
    return quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3).astype(np.int32)


def _many(look: Look, points: FloatArray, colours: Points, faces: Faces) -> Shape:
    """Copies of a template. points: (N, V, 3). colours: (N or 1, V, 4). faces: (F, 3) of one."""
    n, v = points.shape[:2]
    every = faces + (v * np.arange(n, dtype=np.int32))[:, None, None]
    full = np.broadcast_to(colours, (n, v, 4)).reshape(-1, 4)
    return Shape(look, points.reshape(-1, 3).astype(np.float32), full, every.reshape(-1, 3))


@dataclass(frozen=True)
class _Turned:
    """A template turned about an axis, as rings of corners: (V,) arrays but the faces.

    around: rad. wide: radii from the axis. from_tip: radii behind the tip. far: 0 for corners at
    the foot, 1 for those that count from the tip. out, ahead: of the normals.
    """

    around: FloatArray
    wide: FloatArray
    from_tip: FloatArray
    far: FloatArray
    out: FloatArray
    ahead: FloatArray
    faces: Faces


@lru_cache(maxsize=1)
def _arrow() -> _Turned:
    slope = np.hypot(TIP_WIDE, TIP_LONG)
    rings = np.array(  # wide, from_tip, far, out, ahead
        [
            (0.0, 0.0, 0.0, 0.0, -1.0),
            (1.0, 0.0, 0.0, 0.7, -0.7),
            (1.0, TIP_LONG, 1.0, 1.0, 0.0),
            (1.0, TIP_LONG, 1.0, 0.0, -1.0),
            (TIP_WIDE, TIP_LONG, 1.0, TIP_LONG / slope, TIP_WIDE / slope),
            (0.0, 0.0, 1.0, TIP_LONG / slope, TIP_WIDE / slope),
        ]
    )
    turn = np.linspace(0.0, 2 * np.pi, SIDES + 1)
    columns = [np.repeat(column, SIDES + 1) for column in rings.T]
    return _Turned(np.tile(turn, len(rings)), *columns, _sheet(len(rings), SIDES + 1))


def arrows(starts: ArrayLike, vectors: ArrayLike, radius: float, colour: ArrayLike) -> Shape:
    """Arrows from starts (N, 3), each as long as its vector (N, 3)."""
    foot = np.asarray(starts, dtype=float).reshape(-1, 3)
    along = np.asarray(vectors, dtype=float).reshape(-1, 3)
    length = np.linalg.norm(along, axis=1)
    seen = length > SHORTEST
    foot, ahead, length = foot[seen], along[seen] / length[seen, None], length[seen, None]
    if not len(foot):
        return none()
    t, (one, other) = _arrow(), _sides(ahead)
    short = np.minimum(radius, TIP_MOST / TIP_LONG * length)  # a tip that fits
    out = np.cos(t.around)[:, None] * one[:, None] + np.sin(t.around)[:, None] * other[:, None]
    lift = t.far * (length - short * t.from_tip)
    points = foot[:, None] + lift[..., None] * ahead[:, None] + (short * t.wide)[..., None] * out
    normals = t.out[:, None] * out + t.ahead[:, None] * ahead[:, None]
    return _many(Look.SOLID, points, painted(colour, shades(normals)), t.faces)


def bodies(
    heads: ArrayLike,
    tails: ArrayLike,
    colour: ArrayLike,
    *,
    size: float = 1.0,
    plump: float = 1.0,
    look: Look = Look.GHOST,
) -> Shape:
    """Bones as long pointed solids, from heads to tails (N, 3).

    size: the figure's, of which 1 is a grown person in these units. plump: times as thick.
    """
    h, t = np.asarray(heads, dtype=float), np.asarray(tails, dtype=float)
    length = np.linalg.norm(t - h, axis=1)
    seen = length > SHORTEST
    h, t, length = h[seen], t[seen], length[seen, None]
    if not len(h):
        return none(look)
    ahead = (t - h) / length
    one, other = _sides(ahead)
    turn = np.linspace(0.0, 2 * np.pi, BODY_SIDES, endpoint=False)[:, None]
    out = np.cos(turn) * one[:, None] + np.sin(turn) * other[:, None]
    wide = plump * np.clip(WIDTH * length, THIN * size, THICK * size)
    rim = (h + WAIST * length * ahead)[:, None] + wide[:, None] * out
    points = np.concatenate([h[:, None], rim, t[:, None]], axis=1)
    normals = np.concatenate([-ahead[:, None], out, ahead[:, None]], axis=1)
    return _many(look, points, painted(colour, shades(normals, AIRY)), _spindle())


@lru_cache(maxsize=1)
def _spindle() -> Faces:
    """Triangles from the head over the rim to the tail."""
    k = np.arange(BODY_SIDES, dtype=np.int32)
    after, tail = (k + 1) % BODY_SIDES + 1, np.full_like(k, BODY_SIDES + 1)
    lower = np.stack([np.zeros_like(k), after, k + 1], axis=1)
    return np.concatenate([lower, np.stack([k + 1, after, tail], axis=1)]).astype(np.int32)


def across(ahead: ArrayLike) -> FloatArray:
    """A unit vector at right angles to each unit vector (..., 3)."""
    a = np.asarray(ahead, dtype=float)
    fixed = np.where(np.abs(a[..., 2:]) < 0.9, (0.0, 0.0, 1.0), (1.0, 0.0, 0.0))
    side = cross(a, fixed)
    return np.asarray(side / np.linalg.norm(side, axis=-1, keepdims=True))


def _sides(ahead: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Two unit vectors at right angles to unit vectors (N, 3), right-handed with them."""
    one = across(ahead)
    return one, cross(ahead, one)


def cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """a x b along the last axis; a few arrays of three are quicker so than by numpy's own."""
    x, y, z = a[..., 0], a[..., 1], a[..., 2]
    u, v, w = b[..., 0], b[..., 1], b[..., 2]
    return np.stack([y * w - z * v, z * u - x * w, x * v - y * u], axis=-1)
