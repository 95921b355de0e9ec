"""Balls, arrows and bodies as shaded triangles, many copies of a template at once: numpy only."""

from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from ....bridge.shapes.limits import directions
from ....bridge.shapes.mesh import grid_faces
from ....bridge.shapes.solids import superellipsoid
from ....bridge.shapes.vectors import across, cross
from ....solver.arrays import BoolArray, FloatArray
from .shapes import AIRY, Faces, Look, Points, Shape, painted, shades, triangles_of

BALL_AROUND, BALL_ALONG = 12, 7  # faces
ARROW_AROUND = 10  # faces
TIP_LONG, TIP_WIDE = 4.5, 2.6  # an arrow's tip, in radii of its shaft
TIP_MOST = 0.6  # of a short arrow is tip
WAIST, WIDTH = 0.18, 0.11  # where a body is widest, and how wide there, in shares of its length
THICK, THIN = 0.055, 0.012  # m at most and least, half a body's width, of a figure of usual size
BODY_AROUND = 6  # faces
SHORTEST_SOLID = 1e-6  # what is shorter has no direction

_SLANT = np.hypot(TIP_WIDE, TIP_LONG)
ARROW_PROFILE = np.array(
    # radii from the axis; radii behind the tip; 0 at the foot, 1 where it counts from the tip;
    # the normal outwards and ahead
    [
        (0.0, 0.0, 0.0, 0.0, -1.0),
        (1.0, 0.0, 0.0, 0.7, -0.7),
        (1.0, TIP_LONG, 1.0, 1.0, 0.0),
        (1.0, TIP_LONG, 1.0, 0.0, -1.0),
        (TIP_WIDE, TIP_LONG, 1.0, TIP_LONG / _SLANT, TIP_WIDE / _SLANT),
        (0.0, 0.0, 1.0, TIP_LONG / _SLANT, TIP_WIDE / _SLANT),
    ]
)


def none(look: Look = Look.SOLID) -> Shape:
    """Nothing to be drawn."""
    return Shape(look, np.zeros((0, 3), np.float32), np.zeros((0, 4), np.float32))


def balls(centres: ArrayLike, radii: ArrayLike, colours: ArrayLike) -> Shape:
    """Balls about (N, 3) centres; radii and colours one or N."""
    c = np.asarray(centres, dtype=float).reshape(-1, 1, 3)
    if not len(c):
        return none()
    unit, triangles = _unit_ball()
    points = c + np.asarray(radii, dtype=float).reshape(-1, 1, 1) * unit
    return _copies(Look.SOLID, points, painted(colours, shades(unit)), triangles)


@lru_cache(maxsize=1)
def _unit_ball() -> tuple[FloatArray, Faces]:
    ball = superellipsoid(BALL_AROUND, BALL_ALONG)
    return ball.points, triangles_of(ball.faces)


def _copies(look: Look, points: FloatArray, colours: Points, triangles: Faces) -> Shape:
    """Copies of a template. points: (N, V, 3). colours: (N or 1, V, 4). triangles: (F, 3)."""
    n, v = points.shape[:2]
    every = triangles + (v * np.arange(n, dtype=np.int32))[:, None, None]
    full = np.broadcast_to(colours, (n, v, 4)).reshape(-1, 4)
    return Shape(look, points.reshape(-1, 3).astype(np.float32), full, every.reshape(-1, 3))


def arrows(starts: ArrayLike, vectors: ArrayLike, radius: float, colour: ArrayLike) -> Shape:
    """Arrows from starts (N, 3), each as long as its vector (N, 3)."""
    foot, ahead, length, _ = _directed(starts, vectors)
    if not len(foot):
        return none()
    wide, behind, far, out, forth = ARROW_PROFILE.T
    short = np.minimum(radius, TIP_MOST / TIP_LONG * length)  # a tip that fits
    lift, spread = far * (length - short * behind), short * wide
    axis, around = ahead[:, None, None], _around(ahead, ARROW_AROUND)[:, None]
    points = foot[:, None, None] + lift[..., None, None] * axis + spread[..., None, None] * around
    normals = out[:, None, None] * around + forth[:, None, None] * axis
    points, normals = (a.reshape(len(foot), -1, 3) for a in (points, normals))
    return _copies(Look.SOLID, points, painted(colour, shades(normals)), _arrow_triangles())


@lru_cache(maxsize=1)
def _arrow_triangles() -> Faces:
    return triangles_of(grid_faces(len(ARROW_PROFILE), ARROW_AROUND, wraps=True))


def bodies(
    heads: ArrayLike,
    tails: ArrayLike,
    colours: ArrayLike,
    *,
    size: float = 1.0,
    plump: float = 1.0,
    look: Look = Look.GHOST,
) -> Shape:
    """Bones as long pointed solids, from heads to tails (N, 3), in one colour or each its (N, 4).

    size: the figure's, of which 1 is a grown person in these units. plump: times as thick.
    """
    head, ahead, length, seen = _directed(heads, np.subtract(tails, heads))
    if not len(head):
        return none(look)
    colour = np.asarray(colours, dtype=float)
    colour = colour if colour.ndim == 1 else colour[seen]
    out = _around(ahead, BODY_AROUND)
    wide = plump * np.clip(WIDTH * length, THIN * size, THICK * size)
    rim = (head + WAIST * length * ahead)[:, None] + wide[:, None] * out
    tail = head + length * ahead
    points = np.concatenate([head[:, None], rim, tail[:, None]], axis=1)
    normals = np.concatenate([-ahead[:, None], out, ahead[:, None]], axis=1)
    return _copies(look, points, painted(colour, shades(normals, AIRY)), _spindle())


@lru_cache(maxsize=1)
def _spindle() -> Faces:
    """Triangles from the head over the rim to the tail."""
    k = np.arange(BODY_AROUND, dtype=np.int32)
    after, tail = (k + 1) % BODY_AROUND + 1, np.full_like(k, BODY_AROUND + 1)
    lower = np.stack([np.zeros_like(k), after, k + 1], axis=1)
    return np.concatenate([lower, np.stack([k + 1, after, tail], axis=1)])


def _directed(
    starts: ArrayLike, vectors: ArrayLike
) -> tuple[FloatArray, FloatArray, FloatArray, BoolArray]:
    """Starts (N, 3), unit vectors (N, 3) and lengths (N, 1) of those that have a direction, and
    which they are."""
    start = np.asarray(starts, dtype=float).reshape(-1, 3)
    along = np.asarray(vectors, dtype=float).reshape(-1, 3)
    length = np.linalg.norm(along, axis=1, keepdims=True)
    seen = length[:, 0] > SHORTEST_SOLID
    return start[seen], along[seen] / length[seen], length[seen], seen


def _around(ahead: FloatArray, count: int) -> FloatArray:
    """(N, count, 3) unit vectors at right angles to unit vectors (N, 3), right-handed."""
    one = across(ahead)
    sides = np.stack([one, cross(ahead, one)], axis=1)
    turn = np.linspace(0.0, 2 * np.pi, count, endpoint=False)
    return np.asarray(directions(turn)[:, :2] @ sides)
