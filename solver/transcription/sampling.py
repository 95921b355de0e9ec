"""Functions of the motion sampled at instants, and the chain rule to the unknowns."""

from copy import copy
from dataclasses import dataclass
from enum import Enum
from functools import cached_property
from typing import Protocol

import numpy as np

from ..arrays import BoolArray, FloatArray, IntArray
from ..body.character import Character
from ..body.kinematics import Pose, forward_kinematics
from ..numerics.splines import ORDER, SplineBasis
from .rows import FORCE_BLOCKS, Layout


class Channel(Enum):
    """Parts of the unknowns that a function may depend on."""

    COM = "com"
    ANGLES = "angles"
    FORCES = "forces"


@dataclass(frozen=True)
class ChannelJacobian:
    """Jacobian (U, m, width) of values by a channel, or by its order-th time derivative."""

    channel: Channel
    order: int
    matrix: FloatArray


class Instants:
    """Instants (U,) s, each in a span, with a basis evaluated there.

    values: derivatives 0 to 2 of the four basis functions, (U, 4) each. force_weights: (U, 2) of
    the span's two force values. blocks: (U, 4) of the unknowns that act in the span.
    """

    def __init__(
        self, basis: SplineBasis, times: FloatArray, spans: IntArray | None = None
    ) -> None:
        self.times = times
        self.spans = basis.spans(times) if spans is None else spans
        self.values = [basis.evaluate(times, k, self.spans) for k in range(3)]
        self.force_weights = basis.force_weights(times, self.spans)
        self.blocks = basis.first_coefficient[self.spans][:, None] + np.arange(ORDER)

    def some(self, which: BoolArray) -> "Instants":
        """Some of them, by flags (U,)."""
        twin = copy(self)
        twin.times = self.times[which]
        twin.spans, twin.blocks = self.spans[which], self.blocks[which]
        twin.values = [each[which] for each in self.values]
        twin.force_weights = self.force_weights[which]
        return twin

    def assemble(self, jacobians: list[ChannelJacobian], layout: Layout) -> FloatArray:
        """Chain rule: Jacobian (U, m, 4, n_block) by the unknowns of each instant's four blocks."""
        count, rows = jacobians[0].matrix.shape[:2]
        jacobian = np.zeros((count, rows, ORDER, layout.n_block))
        for each in jacobians:
            columns = {
                Channel.COM: layout.com,
                Channel.ANGLES: layout.angles,
                Channel.FORCES: layout.forces,
            }[each.channel]
            if each.channel is Channel.FORCES:
                weights = self.force_weights[:, None, :, None]
                jacobian[:, :, FORCE_BLOCKS, columns] += weights * each.matrix[:, :, None]
            else:
                weights = self.values[each.order][:, None, :, None]
                jacobian[..., columns] += weights * each.matrix[:, :, None]
        return jacobian


@dataclass(frozen=True)
class State:
    """The motion's state at instants: unknowns x (K, n_block) interpolated there."""

    character: Character
    layout: Layout
    instants: Instants
    x: FloatArray

    @cached_property
    def _window(self) -> FloatArray:
        return np.asarray(self.x[self.instants.blocks])

    def com(self, order: int = 0) -> FloatArray:
        """(U, 3) centre of mass, m, world; or its order-th time derivative."""
        window = self._window[:, :, self.layout.com]
        return np.asarray(np.einsum("uk,ukj->uj", self.instants.values[order], window))

    def angles(self, order: int = 0) -> FloatArray:
        """(U, n_angles) joint angles, rad; or their order-th time derivative."""
        window = self._window[:, :, self.layout.angles]
        return np.asarray(np.einsum("uk,ukj->uj", self.instants.values[order], window))

    @cached_property
    def forces(self) -> FloatArray:
        """(U, P, 3) contact forces, body weights, world."""
        window = self._window[:, FORCE_BLOCKS, self.layout.forces]
        values = np.einsum("uk,ukj->uj", self.instants.force_weights, window)
        return np.asarray(values.reshape(len(values), self.layout.n_points, 3))

    @cached_property
    def pose(self) -> Pose:
        """Forward kinematics relative to the centre of mass."""
        return forward_kinematics(self.character, self.angles())


class MotionFunction(Protocol):
    """A function of the motion at instants, with its Jacobian."""

    def value(self, state: State) -> FloatArray:
        """(U, m) at the state's instants."""

    def jacobians(self, state: State) -> list[ChannelJacobian]:
        """Jacobians of `value` by the channels that it depends on."""
