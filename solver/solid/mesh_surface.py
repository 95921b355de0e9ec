"""Objects of the scene as surfaces: the body's capsules and soles are kept out of their meshes."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import FloatArray, IntArray
from ..body.character import Character
from ..body.kinematics import BodyPoint
from ..scene.object_motion import ObjectMotion
from ..scene.triangle_mesh import TriangleMesh
from .shape_changes import AS_IS, ShapeChanges
from .shapes import FEET, SOLID_SHARE, Capsule, Capsules, capsules, floor_balls
from .surfaces import WORLD, Closest, Placed, axes_in

SAMPLING = 0.06  # m along an axis, between the points from which its deepest is sought
GOLDEN = 0.5 * (np.sqrt(5.0) - 1.0)
NARROWINGS = 10  # by the golden section: to 1 mm of an axis


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
        share = deepest_shares(self.mesh, start, end)[:, None]
        found = self.mesh.distances(start + share * (end - start))
        _, turns = self.motion.at(placed.times)
        normal = np.einsum("nij,nj->ni", turns[instants], found.normal)
        first, last = self.shapes.some_ends(placed.pose, instants, items)
        at = first + share * (last - first)
        bodies = self.shapes.bodies[items]
        both = np.stack([bodies, np.full(len(items), WORLD)], axis=1)
        distance = found.distance - self.shapes.radius[items]
        return Closest(
            distance, normal, both, np.stack([at, at], axis=1), np.full(len(items), np.inf)
        )


def deepest_shares(mesh: TriangleMesh, start: FloatArray, end: FloatArray) -> FloatArray:
    """Shares (N,) in [0, 1] of the deepest points of segments from start to end (N, 3) m.

    The least of samples, then the golden section between its neighbours: about the least sample
    the distance from a solid has one minimum, as far as the samples can tell.
    """
    along = end - start
    longest = float(np.linalg.norm(along, axis=1).max(initial=0.0))
    if longest == 0.0:
        return np.zeros(len(start))
    samples = np.linspace(0.0, 1.0, 2 + int(longest / SAMPLING))

    def depth(share: FloatArray) -> FloatArray:
        return mesh.distances(start + share[:, None] * along).distance

    found = np.stack([depth(np.full(len(start), share)) for share in samples], axis=1)
    least = found.argmin(axis=1)
    low, high = samples[np.maximum(least - 1, 0)], samples[np.minimum(least + 1, len(samples) - 1)]
    inner, outer = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
    at_inner, at_outer = depth(inner), depth(outer)
    for _ in range(NARROWINGS):
        left = at_inner < at_outer
        low, high = np.where(left, low, inner), np.where(left, outer, high)
        new = np.where(left, high - GOLDEN * (high - low), low + GOLDEN * (high - low))
        at_new = depth(new)
        inner, outer = np.where(left, new, outer), np.where(left, inner, new)
        at_inner, at_outer = np.where(left, at_new, at_outer), np.where(left, at_inner, at_new)
    shares = np.stack([samples[least], np.where(at_inner < at_outer, inner, outer)])
    depths = np.stack([found.min(axis=1), np.minimum(at_inner, at_outer)])
    return np.asarray(np.take_along_axis(shares, depths.argmin(axis=0)[None], axis=0)[0])
