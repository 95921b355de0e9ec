"""Measures of one joint's rotation, as constraint functions: bend, cone, twist (thesis 3.3.3).

A joint's rotation R takes its child's frame to its parent's; both are the world's in the rest pose.
A measure is a scalar of R with its gradient by a small turn of the child; Jacobians follow from the
joint's axes.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass, field

import numpy as np

from ..arrays import FloatArray
from ..body.anatomy import Part
from ..body.character import Body, Character, Joint
from ..body.human_limits import MIN_BEND_SINE, ON_AXIS, beyond_edge
from ..data.row_kinds import RowKind
from ..numerics.rotations import perpendicular, quaternion, unit
from .sampling import Channel, ChannelJacobian, State


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


@dataclass(frozen=True)
class JointMeasure(ABC):
    """A scalar of a joint's rotation, rad."""

    joint: Joint

    @abstractmethod
    def of(self, R: FloatArray) -> FloatArray:
        """(U,) of rotations (U, 3, 3), child to parent."""

    @abstractmethod
    def gradient(self, R: FloatArray) -> FloatArray:
        """(U, 3) by a small turn of the child, in the parent's frame."""

    def past(
        self, R: FloatArray, lower: FloatArray | float, upper: FloatArray | float
    ) -> FloatArray:
        """(2, U) rad that rotations (U, 3, 3) are past a lower and an upper end, of all or of each;
        below 0 within."""
        found = self.of(R)
        return np.stack([lower - found, found - upper])

    def rotations(self, state: State) -> FloatArray:
        """(U, 3, 3) of the joint, child to parent."""
        return self.joint.axes.rotation(state.angles()[:, self.joint.dofs])

    def value(self, state: State) -> FloatArray:
        return self.of(self.rotations(state))[:, None]

    def jacobians(self, state: State) -> list[ChannelJacobian]:
        full = self.by_angles(state.character, state.angles())
        return [ChannelJacobian(Channel.ANGLES, 0, full[:, None])]

    def by_angles(self, character: Character, angles: FloatArray) -> FloatArray:
        """(U, n_angles) derivatives at joint angles (U, n_angles) rad."""
        R, axes = joint_frame(self.joint, angles)
        full = np.zeros((len(R), character.n_angles))
        full[:, self.joint.dofs] = np.einsum("udi,ui->ud", axes, self.gradient(R))
        return full


@dataclass(frozen=True)
class BendAngle(JointMeasure):
    """Flexion angle of a bone against the straight limb, rad, positive towards `flexion`.

    along (3,): the bone's direction, child's frame. straight, flexion (3,): unit, at right
    angles, parent's frame.
    """

    along: FloatArray
    straight: FloatArray
    flexion: FloatArray
    kind: RowKind = RowKind.BEND

    def of(self, R: FloatArray) -> FloatArray:
        direction = R @ self.along
        return np.asarray(np.arctan2(direction @ self.flexion, direction @ self.straight))

    def gradient(self, R: FloatArray) -> FloatArray:
        direction = R @ self.along
        x, y = direction @ self.straight, direction @ self.flexion
        across = x[:, None] * self.flexion - y[:, None] * self.straight
        return np.asarray(np.cross(direction, across) / (x**2 + y**2)[:, None])


@dataclass(frozen=True)
class SideAngle(JointMeasure):
    """Angle of a bone out of a plane through the joint, rad, positive towards its normal.

    along (3,): the bone's direction, child's frame. normal (3,): unit, parent's frame.
    """

    along: FloatArray
    normal: FloatArray
    kind: RowKind = RowKind.BEND

    def of(self, R: FloatArray) -> FloatArray:
        return np.asarray(np.arcsin(np.clip(R @ self.along @ self.normal, -1.0, 1.0)))

    def gradient(self, R: FloatArray) -> FloatArray:
        turned = np.cross(R @ self.along, self.normal)  # as long as the angle's cosine
        size = np.linalg.norm(turned, axis=1, keepdims=True)
        return np.asarray(turned / np.maximum(size, 1e-9))


@dataclass(frozen=True)
class ConeAngle(JointMeasure):
    """Angle between a bone and a cone's axis, rad, its cross directions divided by `stretch`.

    along (3,): the bone's direction, child's frame. frame (3, 3): rows the axis and the two cross
    directions, parent's frame. The thesis's a . S R l, as an angle. Where a stretch is not 1 it is
    the angle of a squeezed direction, and tells whether a bone is outside a cone but not how far:
    that `past` tells.
    """

    along: FloatArray
    frame: FloatArray
    stretch: FloatArray
    kind: RowKind = RowKind.CONE

    def of(self, R: FloatArray) -> FloatArray:
        parts = R @ self.along @ self._shape.T
        return np.asarray(np.arctan2(np.linalg.norm(parts[:, 1:], axis=1), parts[:, 0]))

    def gradient(self, R: FloatArray) -> FloatArray:
        direction, shape = R @ self.along, self._shape
        parts = direction @ shape.T
        across = np.linalg.norm(parts[:, 1:], axis=1)
        unit_parts = parts[:, 1:] / np.maximum(across, ON_AXIS)[:, None]
        unit_parts[across < ON_AXIS] = 1.0, 0.0  # every way leads off the axis; one must do
        outward = unit_parts @ shape[1:]
        towards = parts[:, :1] * outward - across[:, None] * shape[0]
        return np.asarray(np.cross(direction, towards) / (across**2 + parts[:, 0] ** 2)[:, None])

    def past(
        self, R: FloatArray, lower: FloatArray | float, upper: FloatArray | float
    ) -> FloatArray:
        """An angle in space at the upper end, straight off the axis; a cone has no lower one."""
        below = lower - self.of(R)
        return np.stack([below, beyond_edge(self._parts(R), upper, self.stretch)])

    def _parts(self, R: FloatArray) -> FloatArray:
        """(U, 3) the bone's direction along the axis and in the cross directions."""
        return np.asarray(R @ self.along @ self.frame.T)

    @property
    def _shape(self) -> FloatArray:
        """(3, 3) rows: axis, and cross directions over their stretch."""
        return np.asarray(self.frame / np.array([1.0, *self.stretch])[:, None])


@dataclass(frozen=True)
class TwistAngle(JointMeasure):
    """Axial rotation of a bone against its parent, rad (swing-twist decomposition).

    zero (3, 3): the rotation, child to parent, without twist; the rest pose by default. It is
    singular half a turn of swing away from there. along (3,): the bone's direction in that pose.
    """

    along: FloatArray
    kind: RowKind = RowKind.TWIST
    zero: FloatArray = field(default_factory=lambda: np.eye(3))

    def of(self, R: FloatArray) -> FloatArray:
        w, v = self._quaternion(R)
        return np.asarray(2.0 * np.arctan2(v @ self.along, w))

    def gradient(self, R: FloatArray) -> FloatArray:
        w, v = self._quaternion(R)
        s = v @ self.along
        # q' = (0, omega) q / 2, omega an axis in the parent's frame
        by = w[:, None] * (w[:, None] * self.along + np.cross(v, self.along)) + s[:, None] * v
        return np.asarray(by / (w**2 + s**2)[:, None])

    def _quaternion(self, R: FloatArray) -> tuple[FloatArray, FloatArray]:
        q = quaternion(R @ self.zero.T)
        return q[:, 0].copy(), q[:, 1:]  # side by side: see rotations.py


# ---------------------------------------------------------------- of a character's joints


def bend_angle(character: Character, body: int, angles: FloatArray) -> BendAngle:
    """Flexion angle of a body's joint, positive the way it bends in the mean of angles
    (T, n_angles) rad; where it hardly does, the anatomical way."""
    joint, parent = character.joints[body], character.bodies[character.joints[body].parent]
    along, straight = unit(character.bodies[body].tip), unit(parent.tip)
    mean = (joint.axes.rotation(angles[:, joint.dofs]) @ along).mean(axis=0)
    across = mean - straight * (mean @ straight)
    if np.linalg.norm(across) < MIN_BEND_SINE:
        across = _expected_flexion(character.bodies[body], straight)
    return BendAngle(joint, along, straight, unit(across))


def _expected_flexion(body: Body, straight: FloatArray) -> FloatArray:
    """Anatomical flexion direction (3,): knees backwards, all else forwards, across the limb."""
    forward = body.box_rotation[:, 1]
    forward = -forward if body.part is Part.SHANK else forward
    across = forward - straight * (forward @ straight)
    return across if np.linalg.norm(across) > MIN_BEND_SINE else perpendicular(straight)


def cone_angle(
    character: Character, body: int, axis: FloatArray, stretch: tuple[float, float]
) -> ConeAngle:
    """Angle of a body's bone from an axis (3,) unit in its parent's rest frame; stretch: sideways,
    forwards."""
    sideways = character.bodies[0].box_rotation[:, 0]
    first = sideways - axis * (sideways @ axis)
    first = unit(first) if np.linalg.norm(first) > 0.3 else perpendicular(axis)
    frame = np.stack([axis, first, np.cross(axis, first)])
    along = unit(character.bodies[body].tip)
    return ConeAngle(character.joints[body], along, frame, np.array(stretch, dtype=float))
