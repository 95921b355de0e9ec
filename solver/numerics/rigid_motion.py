"""Rigid motions as functions of time, by smooth interpolation of sampled poses."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import FloatArray, IntArray
from .rotations import cross_matrix, rotation_matrix, rotation_vector


@dataclass(frozen=True)
class Poses:
    """Rigid poses x -> turn x + shift at T instants, or their rates of change.

    turn: (T, 3, 3). shift: (T, 3) m.
    """

    turn: FloatArray
    shift: FloatArray

    def of(self, point: FloatArray) -> FloatArray:
        """(T, 3) where the poses put one point (3,), or points (T, 3) one by one, m."""
        points = np.broadcast_to(point, self.shift.shape)
        return np.asarray(np.einsum("tij,tj->ti", self.turn, points) + self.shift)

    def back(self, points: FloatArray) -> FloatArray:
        """(T, 3) what the poses put at points (T, 3), one by one, m."""
        return np.asarray(np.einsum("tji,tj->ti", self.turn, points - self.shift))

    def after(self, first: Poses) -> Poses:
        """These poses of what `first` has moved; of T, or one for all."""
        return Poses(self.turn @ first.turn, self.of(first.shift))

    @staticmethod
    def still(count: int) -> Poses:
        """The pose that moves nothing."""
        return Poses(np.tile(np.eye(3), (count, 1, 1)), np.zeros((count, 3)))

    @staticmethod
    def resting(count: int) -> Poses:
        """The rates of a pose that stays."""
        return Poses(np.zeros((count, 3, 3)), np.zeros((count, 3)))


@dataclass(frozen=True, eq=False)
class SampledPoses:
    """Interpolation of poses at (T,) ascending instants, T at least 2; velocities are continuous.

    Cubic Hermite splines, of the places (T, 3), and of the rotation vectors from each of the
    rotations (T, 3, 3) to the next, with the slopes of the parabolas through three neighbours; a
    steady spin is exact. Neighbours are less than half a turn apart. Before the first and after
    the last instant the pose is that one's, and the velocity too.
    """

    times: FloatArray
    positions: FloatArray
    rotations: FloatArray

    @cached_property
    def _velocities(self) -> FloatArray:
        """(T, 3) of the places."""
        return self._slopes(np.diff(self.positions, axis=0))

    @cached_property
    def _turns(self) -> FloatArray:
        """(T - 1, 3) rotation vectors from sample to sample, rad."""
        R = self.rotations
        return rotation_vector(np.swapaxes(R[:-1], 1, 2) @ R[1:])

    @cached_property
    def _spins(self) -> FloatArray:
        """(T, 3) angular velocities in the samples' own axes."""
        return self._slopes(self._turns)

    @cached_property
    def _arrivals(self) -> FloatArray:
        """(T - 1, 3) rates of the rotation vectors from sample to sample, at the second."""
        spins = self._spins[1:, :, None]
        return np.asarray(np.linalg.solve(_right_jacobian(self._turns), spins)[..., 0])

    def _slopes(self, steps: FloatArray) -> FloatArray:
        """(T, 3) slopes at the samples, from the steps (T - 1, 3) between them."""
        length = np.diff(self.times)[:, None]
        rate = steps / length
        if len(rate) == 1:
            return np.concatenate([rate, rate])
        inner = (length[1:] * rate[:-1] + length[:-1] * rate[1:]) / (length[1:] + length[:-1])
        ends = 2.0 * rate[0] - inner[0], 2.0 * rate[-1] - inner[-1]
        return np.concatenate([ends[0][None], inner, ends[1][None]])

    def poses(self, times: FloatArray) -> Poses:
        """At instants (U,), in the unit of `times`."""
        places, _ = self._places(times)
        i, bend, _ = self._bend(times)
        return Poses(self.rotations[i] @ rotation_matrix(bend), places)

    def rates(self, times: FloatArray) -> Poses:
        """Derivatives of `poses`."""
        _, velocities = self._places(times)
        i, bend, rate = self._bend(times)
        turn = self.rotations[i] @ rotation_matrix(bend)
        spin = np.einsum("uij,uj->ui", _right_jacobian(bend), rate)
        return Poses(turn @ cross_matrix(spin), velocities)

    def _places(self, times: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Places (U, 3) and their derivatives."""
        i, share, length = self._spans(times)
        ends = self._velocities[i], self._velocities[i + 1]
        step, rate = _hermite(self.positions[i + 1] - self.positions[i], ends, share, length)
        return self.positions[i] + step, rate

    def _bend(self, times: FloatArray) -> tuple[IntArray, FloatArray, FloatArray]:
        """The sample before each instant (U,), rotation vectors (U, 3) from there, and their
        derivatives."""
        i, share, length = self._spans(times)
        ends = self._spins[i], self._arrivals[i]
        return i, *_hermite(self._turns[i], ends, share, length)

    def _spans(self, times: FloatArray) -> tuple[IntArray, FloatArray, FloatArray]:
        """The sample (U,) before each instant, the share (U, 1) of the way to the next, and the
        time (U, 1) between the two."""
        at = np.clip(times, self.times[0], self.times[-1])
        i = np.clip(np.searchsorted(self.times, at, side="right") - 1, 0, len(self.times) - 2)
        length = (self.times[i + 1] - self.times[i])[:, None]
        return i, (at - self.times[i])[:, None] / length, length


def _hermite(
    step: FloatArray, slopes: tuple[FloatArray, FloatArray], share: FloatArray, length: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Cubics from zero to step (U, 3) at a share (U, 1) of a length (U, 1), and derivatives."""
    first, last = (length * slope for slope in slopes)
    square, cube = 3.0 * step - 2.0 * first - last, first + last - 2.0 * step
    value = share * (first + share * (square + share * cube))
    return value, (first + share * (2.0 * square + 3.0 * share * cube)) / length


def _right_jacobian(vector: FloatArray) -> FloatArray:
    """(U, 3, 3) from rates of rotation vectors (U, 3) to angular velocities in turned axes.

    Chirikjian, Stochastic Models, Information Theory, and Lie Groups 2 (2012), 10.86.
    """
    angle = np.linalg.norm(vector, axis=1)[:, None, None]
    K = cross_matrix(vector)
    half = 0.5 * np.sinc(angle / (2.0 * np.pi)) ** 2
    small = np.maximum(angle, 1e-3)
    rest = np.where(angle > 1e-3, (small - np.sin(small)) / small**3, 1.0 / 6.0)
    return np.asarray(np.eye(3) - half * K + rest * (K @ K))
