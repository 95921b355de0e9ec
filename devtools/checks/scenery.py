"""Objects of the scene in MuJoCo: how deep a figure is in them, how far off it stands on them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...solver.arrays import FloatArray
from ...solver.data.scene import SceneObject
from ...solver.scene.object_motion import ObjectMotion
from ...solver.solid.shapes import Capsule
from .mujoco_shapes import NEAR, Poses, ShapeModel, convex_pieces

FAR = 0.2  # m, further off than which nobody stands on anything


@dataclass(frozen=True, eq=False)
class PlacedObject:
    """An object as convex solids, the corners (N, 3) m of each in the object's axes.

    turns (T, 3, 3), places (T, 3) m: to the world at the action's frames.
    """

    name: str
    pieces: tuple[FloatArray, ...]
    turns: FloatArray
    places: FloatArray


def placed_object(
    thing: SceneObject, times: FloatArray, first_frame: float, rate: float
) -> PlacedObject:
    """Where an object is at instants (T,) s. first_frame: the scene's at 0 s; rate: frames a s."""
    places, turns = ObjectMotion.of(thing, first_frame, rate).at(times)
    pieces = tuple(convex_pieces(thing.vertices, thing.triangles))
    return PlacedObject(thing.name, pieces, turns, places)


def scene_depths(
    shapes: Sequence[Capsule], objects: Sequence[PlacedObject], poses: Poses
) -> FloatArray:
    """(T, O x S) m that each shape is in each object, object by object."""
    return np.maximum(-_nearest(shapes, objects, poses, NEAR), 0.0)


def distances_to(points: Sequence[Capsule], thing: PlacedObject, poses: Poses) -> FloatArray:
    """(T, P) m of points (balls) above an object's faces, at most FAR; negative below."""
    return _nearest(points, [thing], poses, FAR)


def _nearest(
    shapes: Sequence[Capsule], objects: Sequence[PlacedObject], poses: Poses, most: float
) -> FloatArray:
    """(T, O x S) m: of every shape to the nearest, or deepest, piece of each object."""
    bodies = poses.places.shape[1]
    owners = [o for o, each in enumerate(objects) for _ in each.pieces]
    model = ShapeModel.of(shapes, bodies, [piece for each in objects for piece in each.pieces])
    turns = [poses.turns, *(objects[o].turns[:, None] for o in owners)]
    places = [poses.places, *(objects[o].places[:, None] for o in owners)]
    every = Poses(np.concatenate(turns, axis=1), np.concatenate(places, axis=1))
    pairs = [(f"capsule {s}", f"solid {p}") for p in range(len(owners)) for s in range(len(shapes))]
    found = model.distances(every, pairs, most).reshape(len(poses.places), len(owners), -1)
    mine = [np.flatnonzero(np.array(owners) == o) for o in range(len(objects))]
    parts = [found[:, pieces].min(axis=1) for pieces in mine]
    return np.concatenate(parts, axis=1)
