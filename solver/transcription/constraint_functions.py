"""Constraint functions of pose and force: bend, cone, twist, point, orientation (thesis 3.3.3).

Each gives values (U, m) at a state's instants and their Jacobians; see sampling.MotionFunction. A
joint's rotation takes its child's frame to its parent's; both are the world's in the rest pose.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray, IntArray
from ..body.character import Character, Joint
from ..body.kinematics import BodyPoint
from ..data.row_kinds import RowKind
from ..numerics.rotations import cross_matrix, rotation_vector
from .sampling import Channel, ChannelJacobian, State

TimeFunction = Callable[[FloatArray], FloatArray]  # of instants (U,) s


def joint_frame(joint: Joint, angles: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Rotations (U, 3, 3) child to parent, and each angle's axis (U, dofs, 3) in the parent.

    angles: (U, n_angles) rad, of the whole character.
    """
    mine = angles[:, joint.dofs]
    axes = np.empty((len(mine), joint.axes.dofs, 3))
    for k in range(joint.axes.dofs):
        until = type(joint.axes)(k, joint.axes.before, np.eye(3))
        axes[:, k] = until.rotation(mine[:, :k])[:, :, k]
    return joint.axes.rotation(mine), axes


def _by_joint(character: Character, joint: Joint, matrix: FloatArray) -> list[ChannelJacobian]:
    """Jacobian by every angle, from that by one joint's (U, m, dofs)."""
    full = np.zeros((*matrix.shape[:2], character.n_angles))
    full[..., joint.dofs] = matrix
    return [ChannelJacobian(Channel.ANGLES, 0, full)]


@dataclass(frozen=True)
class BendAngle:
    """Flexion angle of a bone against the straight limb, rad, positive towards `flexion`.

    along (3,): the bone's direction, child's frame. straight, flexion (3,): unit, at right
    angles, parent's frame.
    """

    joint: Joint
    along: FloatArray
    straight: FloatArray
    flexion: FloatArray
    kind: RowKind = RowKind.BEND

    def value(self, state: State) -> FloatArray:
        x, y, _, _ = self._parts(state)
        return np.arctan2(y, x)[:, None]

    def jacobians(self, state: State) -> list[ChannelJacobian]:
        x, y, direction, axes = self._parts(state)
        moved = np.cross(axes, direction[:, None])
        by = (moved @ self.flexion) * x[:, None] - (moved @ self.straight) * y[:, None]
        by /= (x**2 + y**2)[:, None]
        return _by_joint(state.character, self.joint, by[:, None])

    def _parts(self, state: State) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        R, axes = joint_frame(self.joint, state.angles())
        direction = R @ self.along
        return direction @ self.straight, direction @ self.flexion, direction, axes


@dataclass(frozen=True)
class ConeAngle:
    """Angle between a bone and a cone's axis, rad, its cross directions divided by `stretch`.

    along (3,): the bone's direction, child's frame. frame (3, 3): rows the axis and the two cross
    directions, parent's frame. The thesis's a . S R l, as an angle so that its size says how far.
    """

    joint: Joint
    along: FloatArray
    frame: FloatArray
    stretch: FloatArray
    kind: RowKind = RowKind.CONE

    def value(self, state: State) -> FloatArray:
        parts, _ = self._parts(state)
        return np.arctan2(np.linalg.norm(parts[:, 1:], axis=1), parts[:, 0])[:, None]

    def jacobians(self, state: State) -> list[ChannelJacobian]:
        parts, by = self._parts(state)
        across = np.linalg.norm(parts[:, 1:], axis=1)
        outward = parts[:, 1:] / np.maximum(across, 1e-9)[:, None]
        rate = np.einsum("udk,uk->ud", by[..., 1:], outward) * parts[:, :1]
        rate -= by[..., 0] * across[:, None]
        rate /= (across**2 + parts[:, 0] ** 2)[:, None]
        return _by_joint(state.character, self.joint, rate[:, None])

    def _parts(self, state: State) -> tuple[FloatArray, FloatArray]:
        """Components (U, 3) along axis and cross directions, and derivatives (U, dofs, 3)."""
        R, axes = joint_frame(self.joint, state.angles())
        direction = R @ self.along
        shape = self.frame / np.array([1.0, *self.stretch])[:, None]
        return direction @ shape.T, np.cross(axes, direction[:, None]) @ shape.T


@dataclass(frozen=True)
class TwistAngle:
    """Axial rotation of a bone against its parent, rad (swing-twist decomposition).

    along (3,): the bone's direction in the rest pose.
    """

    joint: Joint
    along: FloatArray
    kind: RowKind = RowKind.TWIST

    def value(self, state: State) -> FloatArray:
        w, v, _ = self._quaternion(state)
        return 2.0 * np.arctan2(v @ self.along, w)[:, None]

    def jacobians(self, state: State) -> list[ChannelJacobian]:
        w, v, axes = self._quaternion(state)
        s = v @ self.along
        # q' = (0, omega) q / 2, omega an axis in the parent's frame
        dw = -0.5 * np.einsum("udi,ui->ud", axes, v)
        dv = 0.5 * (w[:, None, None] * axes + np.cross(axes, v[:, None]))
        by = 2.0 * (w[:, None] * (dv @ self.along) - s[:, None] * dw) / (w**2 + s**2)[:, None]
        return _by_joint(state.character, self.joint, by[:, None])

    def _quaternion(self, state: State) -> tuple[FloatArray, FloatArray, FloatArray]:
        R, axes = joint_frame(self.joint, state.angles())
        turn = rotation_vector(R)
        angle = np.linalg.norm(turn, axis=1)
        v = 0.5 * np.sinc(angle / (2.0 * np.pi))[:, None] * turn
        return np.cos(0.5 * angle), v, axes


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
