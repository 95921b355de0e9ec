"""On which bone of a body another bone keeps its place.

A face may have hundreds of bones, each of which is asked about all bodies at once.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np

from ...solver.arrays import FloatArray
from ..accessors import current_scene
from ..armature.channels import proper
from ..armature.poses import Poses, metres_per_unit
from .moves import is_hidden

_FOLLOWS = 0.005  # m, by which what follows a bone may move in its axes: exporters round
_LEVER = 0.1  # m, by which turns count as places


@dataclass(frozen=True)
class BodyAxes:
    """Those of B bones of a body, apart from what a scale of 0 hides. into: (B, T, 4, 4), from the
    armature's axes into each bone's at T frames. units: (B,) m, of a unit there."""

    names: tuple[str, ...]
    into: FloatArray
    units: FloatArray

    @staticmethod
    def of(poses: Poses, bodies: Sequence[str]) -> BodyAxes:
        """Of a take's poses."""
        every = {name: poses.matrices[:, poses.bones.index(name)] for name in bodies}
        seen = {name: each for name, each in every.items() if not is_hidden(each)}
        metres, world = metres_per_unit(current_scene()), poses.object_to_world[0]
        return BodyAxes(
            tuple(seen),
            np.linalg.inv(np.reshape(list(seen.values()), (-1, *every[bodies[0]].shape))),
            np.array([metres * size_of(world @ each[0]) for each in seen.values()]),
        )

    def followed(self, own: FloatArray, hangs_on: Collection[str]) -> str | None:
        """The bone in whose axes one with poses (T, 4, 4) keeps its place, and turn, best, the
        nearest of equal ones; None where it keeps no place, or is hidden. What hangs on a bone
        follows it anyway."""
        if is_hidden(own):
            return None
        places = self.units[:, None, None] * (self.into[:, :, :3] @ own[:, :, 3:])[..., 0]
        off = extent(places)
        found = []
        for k in np.flatnonzero(off < _FOLLOWS).tolist():
            if self.names[k] not in hangs_on:
                turns = proper(self.into[k, :, :3, :3] @ own[:, :3, :3]).reshape(-1, 9)
                apart = float(off[k] + _LEVER * extent(turns))
                far = float(np.linalg.norm(places[k, 0]))
                found.append((apart + _FOLLOWS * far, self.names[k]))
        return min(found)[1] if found else None


def extent(places: FloatArray) -> FloatArray:
    """(...) how far places (..., T, n) are off their mean at most."""
    off = places - places.mean(axis=-2, keepdims=True)
    return np.asarray(np.linalg.norm(off, axis=-1).max(axis=-1))


def size_of(matrix: FloatArray) -> float:
    """Scale of a transformation (4, 4)."""
    return float(np.cbrt(abs(np.linalg.det(matrix[:3, :3]))))
