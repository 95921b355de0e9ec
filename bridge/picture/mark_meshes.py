"""Marks as meshes: no Blender."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import Enum, auto

import numpy as np

from ...solver.arrays import FloatArray
from ..shapes.limits import cone_rim, directions
from ..shapes.mesh import Mesh, band, joined, quartered
from ..shapes.solids import box, tube
from .annotations import Bar, Box, Cone, Ghost, LimitArc, Mark, Sphere, Thing, Tint
from .limb_meshes import ball

BALL, HOLLOW_BALL = 0.034, 0.03  # m, radii
LINE, RIM, EDGE = 0.009, 0.0055, 0.005  # m, radii of lines: limits, cones' rims, boxes' edges
CONE_AROUND, ARC_CORNERS = 48, 25
TIP = 0.02  # share of a cone's side at which its surface begins


class Look(Enum):
    """Surface style of a mark."""

    SOLID = auto()  # red
    RING = auto()  # red, seen through its middle
    GLASS = auto()  # red, see-through
    LINE = auto()  # dark red
    RIM = auto()  # light red
    VEIL = auto()  # white, see-through
    EDGE = auto()  # grey
    WEIGHT = auto()  # brown
    ENVIRONMENT = auto()  # as the floor, darker
    THING = auto()  # light wood, of the scene
    WALL = auto()  # the same, see-through


@dataclass(frozen=True)
class Solid:
    """A mesh (m) and its look. smooth: whether faces blend."""

    look: Look
    mesh: Mesh

    @property
    def smooth(self) -> bool:
        return self.look not in (Look.VEIL, Look.WEIGHT, Look.THING, Look.WALL)


def merged(parts: Iterable[Solid]) -> tuple[Solid, ...]:
    """One solid for each look."""
    by_look: dict[Look, list[Mesh]] = {}
    for part in parts:
        by_look.setdefault(part.look, []).append(part.mesh)
    return tuple(Solid(look, joined(same)) for look, same in by_look.items())


def solids(mark: Mark) -> Iterator[Solid]:
    """Meshes of a mark at one instant (see `annotations.at`)."""
    match mark:
        case Sphere(place, hollow=hollow):
            look, radius = (Look.RING, HOLLOW_BALL) if hollow else (Look.SOLID, BALL)
            yield Solid(look, ball(radius).placed(np.eye(3), place))
        case Cone():
            yield from _cone(mark)
        case LimitArc():
            yield from _arc(mark)
        case Ghost(centre, rotation, size):
            for c, r, s in zip(centre, rotation, size, strict=True):
                yield from _ghost(_box(c, r, s))
        case Box(centre, rotation, size):
            yield Solid(Look.WEIGHT, _box(centre, rotation, size))
        case Bar(start, end, radius):
            yield Solid(Look.ENVIRONMENT, tube(np.array([start, end]), radius))
        case Thing(points, triangles, wall=wall):
            yield Solid(Look.WALL if wall else Look.THING, quartered(points, triangles))
        case Tint():  # colours a limb, adds nothing
            return


def _cone(cone: Cone) -> Iterator[Solid]:
    axes = np.array([cone.axis, cone.across, np.cross(cone.axis, cone.across)])
    side = cone_rim(cone.half_angle, cone.stretch, cone.length, CONE_AROUND) @ axes
    yield Solid(Look.GLASS, band(cone.apex + TIP * side, cone.apex + side))
    yield Solid(Look.RIM, tube(cone.apex + side, RIM))


def _arc(arc: LimitArc) -> Iterator[Solid]:
    """The line from limit to limit, and from the joint to either; a pane in between."""
    axes = np.array([arc.zero, np.cross(arc.normal, arc.zero), arc.normal])
    spokes = arc.radius * directions(np.linspace(arc.lower, arc.upper, ARC_CORNERS)) @ axes
    rim = arc.centre + spokes
    if arc.upper - arc.lower > 1e-3:
        yield Solid(Look.GLASS, band(arc.centre + TIP * spokes, rim))
        yield Solid(Look.LINE, tube(rim, LINE))
    for end in (rim[0], rim[-1]):
        yield Solid(Look.LINE, tube(np.array([arc.centre, end]), LINE))


def _ghost(mesh: Mesh) -> Iterator[Solid]:
    yield Solid(Look.VEIL, mesh)
    for face in mesh.faces[[0, 1]]:
        yield Solid(Look.EDGE, tube(mesh.points[[*face, face[0]]], EDGE))
    for corner in range(4):
        yield Solid(Look.EDGE, tube(mesh.points[[corner, corner + 4]], EDGE))


def _box(centre: FloatArray, rotation: FloatArray, size: FloatArray) -> Mesh:
    return box(-size / 2, size / 2).placed(rotation, centre)
