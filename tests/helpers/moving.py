"""Objects of a scene that move."""

from collections.abc import Callable

import numpy as np
from hangtime.solver.data.scene import SceneObject, SceneRole, SteadyMotion

FIRST, RATE = 1.0, 100.0  # scene frame of the first instant; scene frames a second
VERTICES = np.array([[-5.0, -5.0, 0.0], [5.0, -5.0, 0.0], [5.0, 5.0, 0.0], [-5.0, 5.0, 0.0]])
TRIANGLES = np.array([[0, 1, 2], [0, 2, 3]])


def ground(steady: SteadyMotion | None, name: str = "ground") -> SceneObject:
    """A square of ten metres on the floor that moves at constant rates."""
    return SceneObject(
        name,
        SceneRole.GROUND,
        VERTICES,
        TRIANGLES,
        np.array([FIRST]),
        np.zeros((1, 3)),
        np.eye(3)[None],
        steady,
    )


def keyed(
    pose: Callable[[float], tuple[np.ndarray, np.ndarray]],
    frames: tuple[float, float, float] = (FIRST, RATE, 61.0),
    name: str = "ground",
) -> SceneObject:
    """The square with a place (3,) m and a rotation (3, 3) at every frame, from seconds.

    frames: the first instant's, frames a second, and the last.
    """
    first, rate, last = frames
    at = np.arange(first, last + 1.0)
    poses = [pose(t) for t in ((at - first) / rate).tolist()]
    positions, rotations = (np.stack(part) for part in zip(*poses, strict=True))
    return SceneObject(name, SceneRole.GROUND, VERTICES, TRIANGLES, at, positions, rotations)
