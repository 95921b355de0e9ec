"""The scene around a performance: solid objects as triangle meshes, still or moving rigidly."""

from dataclasses import dataclass
from enum import Enum

import numpy as np

from ..arrays import FloatArray, IntArray
from .requests import Vector

CLEARANCE = "the clearance of {}"  # an object's, by its name, as reports call it


class SceneRole(Enum):
    """What an object of the scene is to the performer."""

    GROUND = "ground"  # feet land on its faces, and limbs keep out of it
    OBSTACLE = "obstacle"  # limbs keep out of it


@dataclass(frozen=True)
class SupportBox:
    """A box that would carry what nothing in sight does.

    size: (3,) m, along its own axes. place: (3,) m, world; the middle of its base. turn: rad,
    counter-clockwise from above.
    """

    size: Vector
    place: Vector
    turn: float

    @property
    def top(self) -> float:
        """Height, m, world, at which it carries."""
        return self.place[2] + self.size[2]


@dataclass(frozen=True)
class SteadyMotion:
    """Motion at constant rates, on top of the poses that an object has; none at the first instant.

    velocity: (3,) m/s, world. spin: rad/s about the world's vertical through pivot (3,) m, which
    goes along. belt: (3,) m/s in the object's axes, of its surface alone: the object stays.
    """

    velocity: Vector = (0.0, 0.0, 0.0)
    spin: float = 0.0
    pivot: Vector = (0.0, 0.0, 0.0)
    belt: Vector = (0.0, 0.0, 0.0)


@dataclass(frozen=True, eq=False)
class SceneObject:
    """A triangle mesh in the world.

    name: the artist's. vertices: (V, 3) m, in the object's own axes, scale and modifiers applied.
    triangles: (F, 3) indices, counter-clockwise seen from outside. frames: (T,) scene frames,
    ascending, at which positions (T, 3) m and rotations (T, 3, 3), object to world, are known; one
    frame of an object that stands still. steady: how it, or its surface, moves beside, from the
    result's first instant on. part_of: the artist's object of which it is a stiff part; "" for a
    whole one. Two are equal whose values are.
    """

    name: str
    role: SceneRole
    vertices: FloatArray
    triangles: IntArray
    frames: FloatArray
    positions: FloatArray
    rotations: FloatArray
    steady: SteadyMotion | None = None
    part_of: str = ""

    @property
    def whole(self) -> str:
        """Name of the artist's object that it is, or is a part of."""
        return self.part_of or self.name

    @property
    def moves(self) -> bool:
        """Whether it is a platform: it, or its surface, moves while the motion lasts."""
        return len(self.frames) > 1 or self.steady is not None

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, SceneObject):
            return NotImplemented
        pairs = zip(self._arrays, other._arrays, strict=True)
        same = self._called == other._called
        return self is other or (same and all(np.array_equal(one, two) for one, two in pairs))

    def __hash__(self) -> int:
        return hash((self.name, self.role, *(array.shape for array in self._arrays)))

    @property
    def _called(self) -> tuple[str, SceneRole, SteadyMotion | None, str]:
        return self.name, self.role, self.steady, self.part_of

    @property
    def _arrays(self) -> tuple[FloatArray | IntArray, ...]:
        moves = self.frames, self.positions, self.rotations
        return self.vertices, self.triangles, *moves
