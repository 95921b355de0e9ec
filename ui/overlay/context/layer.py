"""A part of the picture: named by its content, built only when that is new."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from enum import Enum, auto

from mathutils import Matrix, Vector

from ..geometry.shapes import Label, Shape

IDENTITY = Matrix.Identity(4).freeze()


def xyz(vector: Vector | Sequence[float]) -> tuple[float, float, float]:
    """Three numbers, whatever they came in."""
    return vector[0], vector[1], vector[2]


class Part(Enum):
    """The parts of the picture."""

    CONTACTS = auto()
    POINTS = auto()
    LIMITS = auto()
    POSES = auto()
    FORCES = auto()
    SHAPES = auto()
    CENTRE = auto()
    RECORDED_PATH = auto()
    ADAPTED_PATH = auto()
    RECORDED_GHOSTS = auto()
    ADAPTED_GHOSTS = auto()
    GHOST_NOW = auto()
    CHANGES = auto()
    FAULTS = auto()


@dataclass(frozen=True)
class Layer:
    """A part of the picture in a space of its own.

    content: equal where the part is. build: makes it. matrix: from there to the world, frozen.
    """

    part: Part
    content: object
    build: Callable[[], Iterable[Shape | Label]]
    matrix: Matrix
