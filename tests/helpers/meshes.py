"""Meshes of scene objects that tests share: boxes, ramps, bumpy grounds, balls."""

import numpy as np
from hangtime.solver.arrays import FloatArray, IntArray
from hangtime.solver.data.scene import SceneObject, SceneRole

Triangles = tuple[FloatArray, IntArray]
QUADS = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))


def box(size: tuple[float, float, float]) -> Triangles:
    """A box about the origin, its faces outwards."""
    shares = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=float)
    triangles = [t for a, b, c, d in QUADS for t in ((a, b, c), (a, c, d))]
    return (shares - 0.5) * size, np.array(triangles)


def ball(radius: float, around: int) -> Triangles:
    """A ball of 2 (around - 1) around triangles."""
    theta = np.linspace(0.0, np.pi, around + 1)[:, None]
    phi = np.linspace(0.0, 2.0 * np.pi, around, endpoint=False)
    parts = np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta) + 0.0 * phi
    points = radius * np.stack(parts, axis=2).reshape(-1, 3)
    i, j = np.indices((around, around))
    a, b = i * around + j, i * around + (j + 1) % around
    faces = [np.stack([a, a + around, b + around], axis=-1), np.stack([a, b + around, b], axis=-1)]
    return points, np.concatenate(faces).reshape(-1, 3)


def thing(
    name: str,
    mesh: Triangles,
    place: tuple[float, float, float] = (0.0, 0.0, 0.0),
    *,
    role: SceneRole = SceneRole.GROUND,
    rotation: FloatArray | None = None,
) -> SceneObject:
    """An object that stands still."""
    turn = np.eye(3) if rotation is None else rotation
    return SceneObject(name, role, *mesh, np.zeros(1), np.array([place]), turn[None])
