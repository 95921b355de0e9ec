"""A motion's state at chosen instants, as the rows of the problem see it."""

from dataclasses import dataclass
from enum import Enum
from functools import cached_property

import numpy as np

from ..arrays import FloatArray, IntArray
from ..body.character import Character
from ..body.kinematics import Pose, forward_kinematics
from ..numerics.splines import ORDER, SplineBasis
from .rows import Layout


class Channel(Enum):
    """What of the unknowns a value depends on."""

    COM = "com"
    ANGLES = "angles"
    FORCES = "forces"


@dataclass(frozen=True)
class Slope:
    """Derivative (U, m, width) of values by a channel, or by its order-th time derivative."""

    channel: Channel
    order: int
    by: FloatArray


class Instants:
    """Instants (U,) s, each in a span, with what a basis is there. Values and derivatives of the
    four basis functions; weights of the span's two force values."""

    def __init__(
        self, basis: SplineBasis, times: FloatArray, spans: IntArray | None = None
    ) -> None:
        self.times = times
        self.spans = basis.spans(times) if spans is None else spans
        self.values = [basis.evaluate(times, k, self.spans) for k in range(3)]
        self.force_weights = basis.force_weights(times, self.spans)
        self.blocks = basis.first_coefficient[self.spans][:, None] + np.arange(ORDER)

    def spread(self, slopes: list[Slope], layout: Layout) -> FloatArray:
        """(U, m, 4, n_block) derivatives by the unknowns of each instant's four blocks."""
        count, rows = slopes[0].by.shape[:2]
        jacobian = np.zeros((count, rows, ORDER, layout.n_block))
        for slope in slopes:
            columns = {
                Channel.COM: layout.com,
                Channel.ANGLES: layout.angles,
                Channel.FORCES: layout.forces,
            }[slope.channel]
            if slope.channel is Channel.FORCES:
                weights = self.force_weights[:, None, :, None]
                jacobian[:, :, 1:3, columns] += weights * slope.by[:, :, None]
            else:
                weights = self.values[slope.order][:, None, :, None]
                jacobian[..., columns] += weights * slope.by[:, :, None]
        return jacobian


@dataclass(frozen=True)
class State:
    """Unknowns x (K, n_block) seen at instants."""

    character: Character
    layout: Layout
    instants: Instants
    x: FloatArray

    @cached_property
    def _window(self) -> FloatArray:
        return np.asarray(self.x[self.instants.blocks])

    def com(self, order: int = 0) -> FloatArray:
        """(U, 3) m, or a time derivative."""
        window = self._window[:, :, self.layout.com]
        return np.asarray(np.einsum("uk,ukj->uj", self.instants.values[order], window))

    def angles(self, order: int = 0) -> FloatArray:
        """(U, n_angles) rad, or a time derivative."""
        window = self._window[:, :, self.layout.angles]
        return np.asarray(np.einsum("uk,ukj->uj", self.instants.values[order], window))

    @cached_property
    def forces(self) -> FloatArray:
        """(U, P, 3) body weights."""
        window = self._window[:, 1:3, self.layout.forces]
        values = np.einsum("uk,ukj->uj", self.instants.force_weights, window)
        return np.asarray(values.reshape(len(values), self.layout.n_points, 3))

    @cached_property
    def pose(self) -> Pose:
        return forward_kinematics(self.character, self.angles())
