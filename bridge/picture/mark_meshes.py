"""Marks as meshes: no Blender."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import Enum, auto

import numpy as np

from ...solver.arrays import FloatArray
from . import meshes
from .annotations import Bar, Box, Cone, Ghost, LimitArc, Mark, Sphere, Tint
from .meshes import IntArray

BALL, HOLLOW_BALL = 0.034, 0.03  # m, radii
LINE, RIM, EDGE = 0.009, 0.0055, 0.005  # m, radii of lines: limits, cones' rims, boxes' edges
TIP = 0.02  # share of a cone's side at which its surface begins


class Look(Enum):
    """How a mark's surface looks."""

    SOLID = auto()  # red
    RING = auto()  # red, seen through its middle
    GLASS = auto()  # red, see-through
    LINE = auto()  # dark red
    RIM = auto()  # light red
    VEIL = auto()  # white, see-through
    EDGE = auto()  # grey
    WEIGHT = auto()  # brown
    ENVIRONMENT = auto()  # as the floor, darker


@dataclass(frozen=True)
class Solid:
    """A mesh and its look. vertices: (V, 3) m. faces: (F, 4). smooth: whether faces blend."""

    look: Look
    vertices: FloatArray
    faces: IntArray

    @property
    def smooth(self) -> bool:
        return self.look not in (Look.VEIL, Look.WEIGHT)


def merged(parts: Iterable[Solid]) -> tuple[Solid, ...]:
    """One solid for each look."""
    by_look: dict[Look, list[Solid]] = {}
    for part in parts:
        by_look.setdefault(part.look, []).append(part)
    return tuple(_joined(look, same) for look, same in by_look.items())


def _joined(look: Look, parts: list[Solid]) -> Solid:
    counts = [len(part.vertices) for part in parts]
    first = np.concatenate([[0], np.cumsum(counts[:-1])]).astype(int)
    faces = [part.faces + start for part, start in zip(parts, first, strict=True)]
    return Solid(look, np.concatenate([part.vertices for part in parts]), np.concatenate(faces))


def solids(mark: Mark) -> Iterator[Solid]:
    """What is drawn for a mark at one instant (see `marks.at`)."""
    match mark:
        case Sphere(place, hollow=hollow):
            look, radius = (Look.RING, HOLLOW_BALL) if hollow else (Look.SOLID, BALL)
            vertices, faces = meshes.ball(radius)
            yield Solid(look, vertices + place, faces)
        case Cone():
            yield from _cone(mark)
        case LimitArc():
            yield from _arc(mark)
        case Ghost(centre, rotation, size):
            for c, r, s in zip(centre, rotation, size, strict=True):
                yield from _ghost(c, r, s)
        case Box(centre, rotation, size):
            yield Solid(Look.WEIGHT, *_box(centre, rotation, size))
        case Bar(start, end, radius):
            yield Solid(Look.ENVIRONMENT, *meshes.tube(np.array([start, end]), radius))
        case Tint():  # colours a limb, adds nothing
            return


def _cone(cone: Cone) -> Iterator[Solid]:
    around = np.linspace(0.0, 2 * np.pi, 49)[:, None]
    other = np.cross(cone.axis, cone.across)
    wide, deep = cone.stretch
    sideways = wide * np.cos(around) * cone.across + deep * np.sin(around) * other
    along = np.cos(cone.half_angle) * cone.axis + np.sin(cone.half_angle) * sideways
    side = cone.length * along / np.linalg.norm(along, axis=1, keepdims=True)
    yield Solid(Look.GLASS, *meshes.band(cone.apex + TIP * side, cone.apex + side))
    yield Solid(Look.RIM, *meshes.tube(cone.apex + side, RIM))


def _arc(arc: LimitArc) -> Iterator[Solid]:
    """The line from limit to limit, and from the joint to either; a pane in between."""
    angles = np.linspace(arc.lower, arc.upper, 25)[:, None]
    other = np.cross(arc.normal, arc.zero)
    spokes = arc.radius * (np.cos(angles) * arc.zero + np.sin(angles) * other)
    rim = arc.centre + spokes
    if arc.upper - arc.lower > 1e-3:
        yield Solid(Look.GLASS, *meshes.band(arc.centre + TIP * spokes, rim))
        yield Solid(Look.LINE, *meshes.tube(rim, LINE))
    for end in (rim[0], rim[-1]):
        yield Solid(Look.LINE, *meshes.tube(np.array([arc.centre, end]), LINE))


def _ghost(centre: FloatArray, rotation: FloatArray, size: FloatArray) -> Iterator[Solid]:
    vertices, faces = _box(centre, rotation, size)
    yield Solid(Look.VEIL, vertices, faces)
    for face in faces[[0, 1]]:
        yield Solid(Look.EDGE, *meshes.tube(vertices[[*face, face[0]]], EDGE))
    for corner in range(4):
        yield Solid(Look.EDGE, *meshes.tube(vertices[[corner, corner + 4]], EDGE))


def _box(centre: FloatArray, rotation: FloatArray, size: FloatArray) -> meshes.Mesh:
    vertices, faces = meshes.block(-size / 2, size / 2)
    return centre + vertices @ rotation.T, faces
