"""How an object of the scene moves: its rigid pose at any instant."""

from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from ..data.scene import SceneObject
from ..numerics.interpolation import interpolate
from ..numerics.rotations import rotation_matrix, rotation_vector


@dataclass(frozen=True)
class ObjectMotion:
    """times: (T,) s, ascending, at which positions (T, 3) m and rotations (T, 3, 3), object to
    world, are known; constant before the first and after the last."""

    times: FloatArray
    positions: FloatArray
    rotations: FloatArray

    @staticmethod
    def of(thing: SceneObject, first_frame: float, rate: float) -> "ObjectMotion":
        """first_frame: scene frame of instant 0; rate: scene frames a second."""
        times = (thing.frames - first_frame) / rate
        return ObjectMotion(times, thing.positions, thing.rotations)

    def at(self, times: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Positions (N, 3) m and rotations (N, 3, 3) at instants (N,) s.

        Positions are cubic where four are known, else linear; rotations go the shortest way.
        """
        if len(self.times) == 1:
            n = len(times)
            return np.tile(self.positions, (n, 1)), np.tile(self.rotations, (n, 1, 1))
        inside = np.clip(times, self.times[0], self.times[-1])
        before = np.clip(np.searchsorted(self.times, inside) - 1, 0, len(self.times) - 2)
        span = self.times[before + 1] - self.times[before]
        share = ((inside - self.times[before]) / span)[:, None]
        start, end = self.rotations[before], self.rotations[before + 1]
        turn = rotation_vector(np.swapaxes(start, 1, 2) @ end)
        if len(self.times) >= 4:
            places = interpolate(self.times, self.positions, inside)
        else:
            places = (1.0 - share) * self.positions[before] + share * self.positions[before + 1]
        return places, start @ rotation_matrix(share * turn)
