"""What errors of channels do to a whole figure: rotations and places in the world, to first order.

Errors are fractions of a degree, of which the second order is some micrometres. So a bone's
channels that are off by d turn all that it carries by `turns` d about its head and shift it by
`shifts` d.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from ...solver.arrays import BoolArray, FloatArray, IntArray


class KeyedChannels(Protocol):
    """Channels that share their keys. samples: (T, n) at every frame. fixed: frames that get a key
    in any case."""

    @property
    def samples(self) -> FloatArray: ...

    @property
    def fixed(self) -> tuple[float, ...]: ...


class KeyableFigure(Protocol):
    """What has keys, at frames (T,), and what it moves, to first order. carried: by its bones."""

    @property
    def frames(self) -> FloatArray: ...

    @property
    def bones(self) -> Sequence[KeyedChannels]: ...

    @property
    def carried(self) -> Sequence[CarriedParts]: ...

    def no_errors(self) -> Errors:
        """Zero at every frame."""

    def errors_by(self, bone: int, off: FloatArray, frames: slice = slice(None)) -> Errors:
        """What is off at some frames, of what one carries, if its channels are off by (T', n)."""

    def worst(
        self, errors: Errors, frames: slice = slice(None), points: IntArray | slice = slice(None)
    ) -> FloatArray:
        """Largest error (T',) at each of some frames, over what it may be. points: those that the
        errors are of."""


@dataclass(frozen=True)
class KeyedBone:
    """Channels that are keyed of one bone, which share their keys.

    samples: (T, n) at every frame. turns: (T, 3, n), rotation vector in the world by channel.
    shifts: (T, 3, n), m in the world by channel. head: (T, 3) m, what it turns about.
    fixed: frames that get a key in any case.
    """

    name: str
    samples: FloatArray
    turns: FloatArray
    shifts: FloatArray
    head: FloatArray
    fixed: tuple[float, ...] = ()


@dataclass(frozen=True)
class KeyedFigure:
    """Bones with keys, B of them, and the points of the body that must stay where they are.

    frames: (T,). carries: (B, B); whether the first carries the second, as it does itself.
    points: (T, P, 3) m, world. owners: (P,) the bones that move them. distances: (T, P) m and
    angle: rad, by which points and bones may be off.
    """

    frames: FloatArray
    bones: tuple[KeyedBone, ...]
    carries: BoolArray
    points: FloatArray
    owners: IntArray
    distances: FloatArray
    angle: float

    @cached_property
    def carried(self) -> tuple[CarriedParts, ...]:
        """By bone what it carries."""
        return tuple(
            CarriedParts(np.flatnonzero(carried), np.flatnonzero(carried[self.owners]))
            for carried in self.carries
        )

    def no_errors(self) -> Errors:
        """Zero at every frame."""
        return Errors(np.zeros((*self.points.shape[:1], len(self.bones), 3)), 0.0 * self.points)

    def errors_by(self, bone: int, off: FloatArray, frames: slice = slice(None)) -> Errors:
        """What its limb is off by at some frames if one bone's channels are off by (T', n)."""
        own = self.bones[bone]
        turn = np.einsum("tin,tn->ti", own.turns[frames], off)[:, None]
        shift = np.einsum("tin,tn->ti", own.shifts[frames], off)[:, None]
        arms = self.points[frames][:, self.carried[bone].points] - own.head[frames, None]
        x, y, z = np.moveaxis(turn, 2, 0)
        u, v, w = np.moveaxis(arms, 2, 0)
        lever = np.stack([y * w - z * v, z * u - x * w, x * v - y * u], axis=2)
        return Errors(turn, shift + lever)

    def worst(
        self, errors: Errors, frames: slice = slice(None), points: IntArray | slice = slice(None)
    ) -> FloatArray:
        """As of KeyableFigure."""
        return errors.worst(self.distances[frames][:, points], self.angle)


@dataclass(frozen=True)
class CarriedParts:
    """Indices of the bones and of the points that a bone carries, itself and its own included."""

    bones: IntArray
    points: IntArray


@dataclass(frozen=True)
class Errors:
    """Of a figure, or of a limb, at T' frames. turns: (T', B, 3) rad, or (T', 1, 3) of a limb that
    turns as one. places: (T', P, 3) m."""

    turns: FloatArray
    places: FloatArray

    def __add__(self, other: Errors) -> Errors:
        return Errors(self.turns + other.turns, self.places + other.places)

    def worst(self, distances: FloatArray, angle: float) -> FloatArray:
        """(T',) the largest over what it may be: m (T', P), and rad."""
        turned = (self.turns**2).sum(axis=2).max(axis=1) / angle**2
        moved = (self.places**2).sum(axis=2) / distances**2
        return np.asarray(np.sqrt(np.maximum(turned, moved.max(axis=1))))

    def of(self, limb: CarriedParts, frames: slice) -> Errors:
        """Of a limb at some frames."""
        return Errors(self.turns[frames][:, limb.bones], self.places[frames][:, limb.points])

    def put(self, limb: CarriedParts, frames: slice, errors: Errors) -> None:
        """Make them these of a limb at some frames."""
        self.turns[frames, limb.bones] = errors.turns
        self.places[frames, limb.points] = errors.places
