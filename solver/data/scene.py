"""The scene around a performance: solid objects as triangle meshes, still or moving rigidly."""

from dataclasses import dataclass
from enum import Enum

import numpy as np

from ..arrays import FloatArray, IntArray


class SceneRole(Enum):
    """What an object of the scene is to the performer."""

    GROUND = "ground"  # feet land on its faces, and limbs keep out of it
    OBSTACLE = "obstacle"  # limbs keep out of it


@dataclass(frozen=True, eq=False)
class SceneObject:
    """A triangle mesh in the world.

    name: the artist's. vertices: (V, 3) m, in the object's own axes, scale and modifiers applied.
    triangles: (F, 3) indices, counter-clockwise seen from outside. frames: (T,) scene frames,
    ascending, at which positions (T, 3) m and rotations (T, 3, 3), object to world, are known; one
    frame of an object that stands still. Two are equal whose values are.
    """

    name: str
    role: SceneRole
    vertices: FloatArray
    triangles: IntArray
    frames: FloatArray
    positions: FloatArray
    rotations: FloatArray

    @property
    def moves(self) -> bool:
        """Whether it is a platform: it moves while the motion lasts."""
        return len(self.frames) > 1

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, SceneObject):
            return NotImplemented
        named = self.name == other.name and self.role is other.role
        pairs = zip(self._arrays, other._arrays, strict=True)
        return self is other or (named and all(np.array_equal(one, two) for one, two in pairs))

    def __hash__(self) -> int:
        return hash((self.name, self.role, *(array.shape for array in self._arrays)))

    @property
    def _arrays(self) -> tuple[FloatArray | IntArray, ...]:
        moves = self.frames, self.positions, self.rotations
        return self.vertices, self.triangles, *moves
