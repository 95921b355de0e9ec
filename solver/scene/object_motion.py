"""How an object of the scene moves: the rigid poses of it, and of its surface, over time."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..arrays import FloatArray
from ..data.constants import UP
from ..data.scene import SceneObject, SteadyMotion
from ..numerics.rigid_motion import Poses, SampledPoses
from ..numerics.rotations import axis_rotation, cross_matrix


@dataclass(frozen=True)
class ObjectMotion:
    """An object over time, s from the result's first instant on.

    Keyed poses follow the scene's frames: the result's clock, however its phases are retimed; they
    are constant before the first and after the last. first_frame: scene frame of that instant.
    rate: scene frames a second.
    """

    thing: SceneObject
    first_frame: float
    rate: float

    @staticmethod
    def of(thing: SceneObject, first_frame: float, rate: float) -> ObjectMotion:
        """first_frame: scene frame of instant 0; rate: scene frames a second."""
        return ObjectMotion(thing, first_frame, rate)

    def frame(self, time: float) -> float:
        """Scene frame of an instant, s."""
        return self.first_frame + self.rate * time

    def at(self, times: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Positions (N, 3) m and rotations (N, 3, 3) of the mesh at instants (N,) s."""
        if self.thing.steady is None:
            poses = self._poses(times)
        else:
            poses = self._moved(times, self._keyed(times))[0]
        return poses.shift, poses.turn

    def still_at(self, time: float) -> SceneObject:
        """The object as it stands at an instant, s, at rest."""
        return self.keyed_at(np.array([self.frame(time)]))

    def keyed_at(self, frames: FloatArray) -> SceneObject:
        """The same object with keys at scene frames (T,) for its steady motion."""
        positions, rotations = self.at((frames - self.first_frame) / self.rate)
        return replace(
            self.thing, frames=frames, positions=positions, rotations=rotations, steady=None
        )

    def surface(self, times: FloatArray) -> Poses:
        """Poses of the surface at instants (N,) s, object to world: a belt runs over the mesh."""
        return self._moved(times, self._on_belt(times))[0]

    def surface_rates(self, times: FloatArray) -> Poses:
        """Rates of change of `surface`."""
        return self._moved(times, self._on_belt(times))[1]

    @cached_property
    def _samples(self) -> SampledPoses | None:
        each = self.thing
        if len(each.frames) < 2:
            return None
        seconds = (each.frames - self.first_frame) / self.rate
        return SampledPoses(seconds, each.positions, each.rotations)

    def _poses(self, times: FloatArray) -> Poses:
        """Poses as keyed."""
        if self._samples is not None:
            return self._samples.poses(times)
        count, each = len(times), self.thing
        turn = np.tile(each.rotations[0], (count, 1, 1))
        return Poses(turn, np.tile(each.positions[0], (count, 1)))

    def _keyed(self, times: FloatArray) -> tuple[Poses, Poses]:
        """Poses as keyed, and their rates."""
        rates = Poses.resting(len(times)) if self._samples is None else self._samples.rates(times)
        return self._poses(times), rates

    def _on_belt(self, times: FloatArray) -> tuple[Poses, Poses]:
        at, rate = self._keyed(times)
        if self.thing.steady is None:
            return at, rate
        belt, passed = np.array(self.thing.steady.belt), times[:, None]
        slides = at.turn @ belt + passed * (rate.turn @ belt)
        moved = Poses(at.turn, at.shift + passed * (at.turn @ belt))
        return moved, Poses(rate.turn, rate.shift + slides)

    def _moved(self, times: FloatArray, poses: tuple[Poses, Poses]) -> tuple[Poses, Poses]:
        steady = self.thing.steady
        return poses if steady is None else _steadily(steady, times, *poses)


def _steadily(
    steady: SteadyMotion, times: FloatArray, at: Poses, rate: Poses
) -> tuple[Poses, Poses]:
    """Poses at instants (N,) s and their rates, with a steady motion on top."""
    velocity, pivot = np.array(steady.velocity), np.array(steady.pivot)
    spin = axis_rotation(2, steady.spin * times)
    spin_rate = steady.spin * cross_matrix(UP) @ spin
    arm = at.shift - pivot
    going = pivot + times[:, None] * velocity
    moved = Poses(spin @ at.turn, going + np.einsum("nij,nj->ni", spin, arm))
    turning = np.einsum("nij,nj->ni", spin_rate, arm) + np.einsum("nij,nj->ni", spin, rate.shift)
    return moved, Poses(spin_rate @ at.turn + spin @ rate.turn, velocity + turning)
