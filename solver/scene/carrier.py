"""Ground that moves, seen from it: the world as it would be had the ground not moved.

What rides on a train stands still on it, and what stands beside it moves.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..arrays import FloatArray
from ..data.contacts import ContactPoint
from ..data.recording import Recording
from ..numerics.rigid_motion import Poses
from .object_motion import ObjectMotion
from .triangle_mesh import TriangleMesh, placed_mesh

REACH = 0.04  # m; feet this far above or below a face may be on it, and levels this near are one


@dataclass(frozen=True)
class Carrier:
    """Ground that moves. Places seen from it are where they would be, m, world, had it not moved
    since the first instant; a belt carries, but its mesh stays."""

    motion: ObjectMotion

    @property
    def name(self) -> str:
        return self.motion.thing.name

    def seen(self, times: FloatArray, points: FloatArray) -> FloatArray:
        """Points (N, 3) m at instants (N,) s, seen from the ground."""
        return _put(self._first, _back(self.motion.surface(times), points))

    def seen_point(self, times: FloatArray, point: ContactPoint) -> ContactPoint:
        """A point that is recorded at instants (T,) s, seen from the ground."""
        pressing = None if point.pressing is None else self.seen(times, point.pressing)
        return replace(point, track=self.seen(times, point.track), pressing=pressing)

    def seen_recording(self, recording: Recording) -> Recording:
        """A recording seen from the ground."""
        now, first = self.motion.surface(recording.times), self._first
        back = first.turn @ np.swapaxes(now.turn, 1, 2)
        local = recording.heads - now.shift[:, None]
        heads = np.einsum("tij,tbj->tbi", back, local) + first.shift
        return replace(recording, heads=heads, rotations=back[:, None] @ recording.rotations)

    def placed(self, place: FloatArray, time: float) -> FloatArray:
        """Where a place (3,) m that is seen from the ground is at an instant, s."""
        local = _back(self._first, place[None])
        return np.asarray(_put(self.motion.surface(np.array([time])), local)[0])

    def heights(self, times: FloatArray, points: FloatArray) -> FloatArray:
        """(N,) m, of the ground that points (N, 3) m, seen from it, may be on at instants (N,) s;
        -inf where there is none."""
        world = _put(self.motion.surface(times), _back(self._first, points))
        shift, turn = self.motion.at(times)
        under = _put(self._first, _back(Poses(turn, shift), world))
        top = self._mesh.heights(under[:, :2]).z + points[:, 2] - under[:, 2]
        return np.where(top < points[:, 2] + REACH, top, -np.inf)

    @cached_property
    def _first(self) -> Poses:
        return self.motion.surface(np.zeros(1))

    @cached_property
    def _mesh(self) -> TriangleMesh:
        return placed_mesh(self.motion.still_at(0.0))


def _put(poses: Poses, points: FloatArray) -> FloatArray:
    """(N, 3) where poses, N or one, put points (N, 3)."""
    turn = np.broadcast_to(poses.turn, (len(points), 3, 3))
    return np.asarray(np.einsum("nij,nj->ni", turn, points) + poses.shift)


def _back(poses: Poses, points: FloatArray) -> FloatArray:
    """(N, 3) what poses, N or one, put at points (N, 3)."""
    turn = np.broadcast_to(poses.turn, (len(points), 3, 3))
    return np.asarray(np.einsum("nji,nj->ni", turn, points - poses.shift))
