"""Constraint functions of pose and force: point, orientation, angles, peak force (thesis 3.3).

Each gives values (U, m) at a state's instants and their Jacobians; see sampling.MotionFunction.
Those of a single joint's rotation are in joint_measures.py.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import FloatArray, IntArray
from ..body.kinematics import BodyPoint
from ..data.row_kinds import RowKind
from ..numerics.rotations import cross_matrix, rotation_vector
from .sampling import Channel, ChannelJacobian, State

NO_TURN = 1e-12  # rad

TimeFunction = Callable[[FloatArray], FloatArray]  # of instants (U,) s


@dataclass(frozen=True)
class PointPosition:
    """Position of a body's point relative to a place that may move, m, along axes' columns (3, k).

    place: (U, 3) m, world; axes in the world.
    """

    point: BodyPoint
    place: TimeFunction
    axes: FloatArray
    kind: RowKind = RowKind.POINT

    def value(self, state: State) -> FloatArray:
        at = state.pose.points([self.point])[:, 0] + state.com()
        return np.asarray((at - self.place(state.instants.times)) @ self.axes)

    def jacobians(self, state: State) -> list[ChannelJacobian]:
        turn = state.pose.point_jacobian([self.point])[:, 0]
        com = np.tile(self.axes.T, (len(turn), 1, 1))
        return [
            ChannelJacobian(Channel.ANGLES, 0, self.axes.T @ turn),
            ChannelJacobian(Channel.COM, 0, com),
        ]


@dataclass(frozen=True)
class BodyOrientation:
    """Rotation vector (U, 3) from a wanted orientation (U, 3, 3) of a body, rad, wanted's axes."""

    body: int
    wanted: TimeFunction
    kind: RowKind = RowKind.ORIENTATION

    def value(self, state: State) -> FloatArray:
        return rotation_vector(self._error(state))

    def jacobians(self, state: State) -> list[ChannelJacobian]:
        off = rotation_vector(self._error(state))
        turned = np.swapaxes(self.wanted(state.instants.times), 1, 2) @ np.swapaxes(
            state.pose.axes, 1, 2
        )
        moves = np.zeros(state.character.n_angles)
        for ancestor in state.character.ancestors(self.body):
            moves[state.character.joints[ancestor].dofs] = 1.0
        return [ChannelJacobian(Channel.ANGLES, 0, _inverse_left_jacobian(off) @ turned * moves)]

    def _error(self, state: State) -> FloatArray:
        wanted = self.wanted(state.instants.times)
        return np.asarray(np.swapaxes(wanted, 1, 2) @ state.pose.rotations[:, self.body])


@dataclass(frozen=True)
class OrientationDistance:
    """Angle (U, 1) of the turn from a wanted orientation to a body's, rad: their geodesic distance.

    At 0, where it has no gradient, the gradient is 0.
    """

    orientation: BodyOrientation
    kind: RowKind = RowKind.ORIENTATION

    def value(self, state: State) -> FloatArray:
        off = self.orientation.value(state)
        return np.asarray(np.linalg.norm(off, axis=1, keepdims=True))

    def jacobians(self, state: State) -> list[ChannelJacobian]:
        off = self.orientation.value(state)
        axis = off / np.maximum(np.linalg.norm(off, axis=1, keepdims=True), NO_TURN)
        (turning,) = self.orientation.jacobians(state)
        return [replace(turning, matrix=axis[:, None] @ turning.matrix)]


def _inverse_left_jacobian(turn: FloatArray) -> FloatArray:
    """(U, 3, 3) inverse left Jacobian of SO(3) at rotation vectors (Chirikjian 2011, 10.86)."""
    angle = np.linalg.norm(turn, axis=1)
    half = 0.5 * np.minimum(angle, np.pi - 1e-6)
    safe = np.maximum(half, 1e-4)
    factor = np.where(half < 1e-4, 1.0 / 12.0, (1.0 - safe / np.tan(safe)) / (2.0 * safe) ** 2)
    skew = cross_matrix(turn)
    return np.asarray(np.eye(3) - 0.5 * skew + factor[:, None, None] * skew @ skew)


@dataclass(frozen=True)
class JointAngles:
    """Joint angles relative to wanted ones (U, k), rad. which: (k,) their indices."""

    which: IntArray
    wanted: TimeFunction
    kind: RowKind = RowKind.POSE

    def value(self, state: State) -> FloatArray:
        off = state.angles()[:, self.which] - self.wanted(state.instants.times)
        return np.asarray(off)

    def jacobians(self, state: State) -> list[ChannelJacobian]:
        by = np.zeros((len(self.which), state.character.n_angles))
        by[np.arange(len(self.which)), self.which] = 1.0
        return [ChannelJacobian(Channel.ANGLES, 0, np.tile(by, (len(state.instants.times), 1, 1)))]


@dataclass(frozen=True)
class PeakForce:
    """Magnitude of the summed contact force, body weights. points: (k,) indices of its points."""

    points: IntArray
    kind: RowKind = RowKind.PEAK

    def value(self, state: State) -> FloatArray:
        total = state.forces[:, self.points].sum(axis=1)
        return np.asarray(np.linalg.norm(total, axis=1)[:, None])

    def jacobians(self, state: State) -> list[ChannelJacobian]:
        total = state.forces[:, self.points].sum(axis=1)
        size = np.maximum(np.linalg.norm(total, axis=1), 1e-9)
        by = np.zeros((len(total), 1, *state.forces.shape[1:]))
        by[:, 0, self.points] = (total / size[:, None])[:, None]
        return [ChannelJacobian(Channel.FORCES, 0, by.reshape(len(total), 1, -1))]
