"""Objects of the scene as surfaces: the body's capsules and soles are kept out of their meshes."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..arrays import FloatArray, IntArray
from ..body.character import Character
from ..body.kinematics import BodyPoint
from ..scene.object_motion import ObjectMotion
from ..scene.triangle_mesh import TriangleMesh
from .bounds import ObjectBounds
from .shape_changes import AS_IS, ShapeChanges
from .shapes import FEET, SOLID_SHARE, Capsule, Capsules, capsules, floor_balls
from .surfaces import WORLD, Closest, Placed, axes_in

SAMPLING = 0.06  # m along an axis, between the points from which its deepest is sought
SHALLOWER = 1e-9  # m, by which the point that is found may be less deep than the deepest
MOST_CUTS = 10
OPPOSITE = -0.5  # the cosine beyond which two ways out go to different sides


def scene_shapes(
    character: Character, points: Sequence[BodyPoint], changes: ShapeChanges = AS_IS
) -> list[Capsule]:
    """What is kept out of objects: the capsules, and of the feet the lines along their soles.

    points: the body points that touch. What stands on an object touches it with the soles' ends;
    a foot's ball gives as other flesh does, as a foot on a slope does not lie in its plane.
    """
    shapes = [c for c in capsules(character, changes) if character.bodies[c.body].part not in FEET]
    shapes += [
        replace(c, radius=SOLID_SHARE * c.radius)
        for c in floor_balls(character, points, changes)
        if character.bodies[c.body].part in FEET
    ]
    for point in points:
        body = character.bodies[point.body]
        if body.part in FEET:
            shapes.append(Capsule(point.body, point.place, body.tip, 0.0))
    return [shape for shape in shapes if shape.body not in changes.loose]


@dataclass(frozen=True)
class MeshSurface:
    """One object: its mesh in its own axes, and how it moves. names: of the shapes' items."""

    mesh: TriangleMesh
    motion: ObjectMotion
    shapes: Capsules
    names: tuple[str, ...]

    @cached_property
    def bounds(self) -> ObjectBounds:
        """Of its mesh's box."""
        return ObjectBounds.of(self.mesh, self.motion, self.shapes)

    def near(self, placed: Placed) -> tuple[IntArray, IntArray]:
        """By the mesh's box, and then by the distance of the axes' middles."""
        instants, items = np.indices((len(placed.times), len(self.names))).reshape(2, -1)
        start, end = axes_in(self.motion, self.shapes, placed, instants, items)
        radius = self.shapes.radius[items]
        low = np.minimum(start, end) - radius[:, None]
        high = np.maximum(start, end) + radius[:, None]
        near = ((low < self.mesh.high) & (high > self.mesh.low)).all(axis=1)
        instants, items, start, end = instants[near], items[near], start[near], end[near]
        reach = 0.5 * np.linalg.norm(end - start, axis=1) + radius[near]
        near = self.mesh.distances(0.5 * (start + end)).distance < reach
        return instants[near], items[near]

    def closest(self, placed: Placed, instants: IntArray, items: IntArray) -> Closest:
        """Of the deepest point of each axis, less the radius."""
        start, end = axes_in(self.motion, self.shapes, placed, instants, items)
        found = deepest(self.mesh, start, end)
        _, turns = self.motion.at(placed.times)
        normal = np.einsum("nij,nj->ni", turns[instants], found.gradient)
        first, last = self.shapes.some_ends(placed.pose, instants, items)
        at = first + found.share[:, None] * (last - first)
        bodies = self.shapes.bodies[items]
        both = np.stack([bodies, np.full(len(items), WORLD)], axis=1)
        distance = found.distance - self.shapes.radius[items]
        return Closest(
            distance, normal, both, np.stack([at, at], axis=1), np.full(len(items), np.inf)
        )


@dataclass(frozen=True)
class Deepest:
    """The deepest points of N segments: shares (N,) in [0, 1], signed distances (N,) m and their
    gradients (N, 3), by the segments' places."""

    share: FloatArray
    distance: FloatArray
    gradient: FloatArray


def deepest(mesh: TriangleMesh, start: FloatArray, end: FloatArray) -> Deepest:
    """Of segments from start to end (N, 3) m.

    The least of samples, then cutting planes (Kelley 1960) between it and its lower neighbour:
    about the least sample the distance from a solid is convex, as far as the samples can tell, and
    where faces are flat two cuts meet in its least.
    """
    every, along = np.arange(len(start)), end - start
    longest = float(np.linalg.norm(along, axis=1).max(initial=0.0))
    samples = np.linspace(0.0, 1.0, 2 + int(longest / SAMPLING))

    def cut(which: IntArray, share: FloatArray) -> FloatArray:
        """(6, M) shares, distances there, their slopes along the segments, and normals."""
        found = mesh.distances(start[which] + share[:, None] * along[which])
        slope = np.einsum("ni,ni->n", found.normal, along[which])
        return np.stack([share, found.distance, slope, *found.normal.T])

    cuts = cut(np.repeat(every, len(samples)), np.tile(samples, len(start)))
    cuts = cuts.reshape(len(cuts), len(start), len(samples))
    least = cuts[1].argmin(axis=1)
    best = cuts[:, every, least]
    beside = np.clip(np.where(best[2] > 0.0, least - 1, least + 1), 0, len(samples) - 1)
    low, high = cuts[:, every, np.minimum(least, beside)], cuts[:, every, np.maximum(least, beside)]
    rest = every
    for _ in range(MOST_CUTS):
        share, bound = _meeting(low[:, rest], high[:, rest])
        deeper = best[1, rest] - bound > SHALLOWER
        rest, share = rest[deeper], share[deeper]
        if not len(rest):
            break
        new = cut(rest, share)
        best[:, rest] = np.where(new[1] < best[1, rest], new, best[:, rest])
        falls = new[2] < 0.0
        low[:, rest] = np.where(falls, new, low[:, rest])
        high[:, rest] = np.where(falls, high[:, rest], new)
    return Deepest(best[0], best[1], _gradient(best, low, high))


def _meeting(low: FloatArray, high: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Where two cuts (6, M) meet, and how deep; the middle, where they do not between them."""
    turn, width = high[2] - low[2], high[0] - low[0]
    steep = turn > 0.0
    ahead = (low[1] - high[1] + high[2] * width) / np.where(steep, turn, 1.0)
    between = steep & (ahead > 0.0) & (ahead < width)
    ahead = np.where(between, ahead, 0.5 * width)
    bound = np.minimum(low[1] + low[2] * ahead, high[1] - high[2] * (width - ahead))
    return low[0] + ahead, np.asarray(bound)


def _gradient(best: FloatArray, low: FloatArray, high: FloatArray) -> FloatArray:
    """(N, 3) gradients of the least distances: the normals of the cuts (6, N) beside, mixed so that
    there is no slope along the segment, as a ridge is left by both its faces; where these look
    different ways out, the normal of one."""
    mixed = (low[2] < 0.0) & (high[2] > 0.0) & ((low[3:] * high[3:]).sum(axis=0) > OPPOSITE)
    share = high[2] / np.where(mixed, high[2] - low[2], 1.0)
    both = share * low[3:] + (1.0 - share) * high[3:]
    return np.asarray(np.where(mixed, both, best[3:]).T)
