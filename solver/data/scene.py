"""The scene around a performance: solid objects as triangle meshes, still or moving rigidly."""

from dataclasses import dataclass
from enum import Enum

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
    frame of an object that stands still.
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
