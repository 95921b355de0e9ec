"""Which objects are near, by boxes along the axes: most are far, whatever their faces are."""

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from ..arrays import FloatArray
from ..data.scene import SceneObject

REMEMBERED = 4  # scenes


def still_near(
    scene: Sequence[SceneObject], points: FloatArray, within: float
) -> list[SceneObject]:
    """Those that stand still and have vertices' boxes nearer than that, m, to that of points (N, 3)
    m, world, on each axis."""
    still = tuple(thing for thing in scene if not thing.moves and len(thing.vertices))
    low, high = _boxes(still)
    first, last = points.min(axis=0) - within, points.max(axis=0) + within
    near = ((low < last) & (high > first)).all(axis=1)
    return [still[k] for k in np.flatnonzero(near).tolist()]


@lru_cache(maxsize=REMEMBERED)
def _boxes(things: tuple[SceneObject, ...]) -> FloatArray:
    """(2, K, 3) m, of objects as they stand at first."""
    places = [each.vertices @ each.rotations[0].T + each.positions[0] for each in things]
    boxes = np.array([(each.min(axis=0), each.max(axis=0)) for each in places])
    return np.moveaxis(boxes.reshape(-1, 2, 3), 1, 0)
