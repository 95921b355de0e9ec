"""Passive joint torques: what tendons, ligaments and resting muscles give without being asked.

A spring and a damper at each joint, for a body of 70 kg; both grow with its mass. The spring turns
the joint to its neutral rotation: limbs hang down, all else is as in the rest pose. Its moment is
k sin(angle), which is k times the angle near the neutral pose and has no seam at half a turn.

Hip, knee, ankle: k is the slope of the elastic moments of Riener and Edrich (Identification of
passive elastic joint moments in the lower extremities, Journal of Biomechanics 32, 1999) for a
relaxed leg: hip bent by 20°, knee by 30°, the foot hanging by 20°. Elbow: the middle of 0.4 to
1.8 N·m/rad that Wiegner and Watts measured (Elastic properties of muscles measured at the elbow in
man, Journal of Neurology, Neurosurgery and Psychiatry 49, 1986). Damping of hip and ankle is of the
order of 1 N·m·s/rad, after Audu and Davy (The influence of muscle model complexity in
musculoskeletal motion modeling, Journal of Biomechanical Engineering 107, 1985), whose figures we
have at second hand. In a typical pendulum test (Wartenberg's) every swing of a relaxed shank comes
about two thirds as far as the one before, a damping ratio of 0.07, which here gives knee,
shoulder, elbow and wrist their damping. For shoulder and wrist we know no such figure of stiffness:
theirs is a quarter of what gravity gives the hanging limb, as it is at the hip. Spine, neck,
collarbone and toes have none here.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import casadi as ca
import numpy as np

from ..arrays import FloatArray, IntArray
from ..data.constants import UP
from ..numerics.batch_function import BatchFunction
from ..numerics.rotations import perpendicular, rotation_matrix, unit
from .anatomy import Part
from .character import Body, Character

MEASURED_MASS = 70.0  # kg, of the body that the figures below are for


@dataclass(frozen=True)
class Viscoelasticity:
    """Linear spring and damper of a joint: N·m/rad and N·m·s/rad."""

    stiffness: float
    damping: float


# By the part below the joint.
PASSIVE_JOINTS: Mapping[Part, Viscoelasticity] = {
    Part.THIGH: Viscoelasticity(10.0, 1.1),
    Part.SHANK: Viscoelasticity(4.0, 0.3),
    Part.FOOT: Viscoelasticity(4.5, 0.9),
    Part.UPPER_ARM: Viscoelasticity(2.5, 0.3),
    Part.FOREARM: Viscoelasticity(1.1, 0.07),
    Part.HAND: Viscoelasticity(0.1, 0.005),
}
HANGING = (Part.THIGH, Part.UPPER_ARM)


def passive_torques(character: Character, q: ca.SX, v: ca.SX, *, orthogonal: bool = False) -> ca.SX:
    """(n_angles,) N·m along the joint angles; none at the root's.

    q, v: (n_angles,) joint angles, rad, and their derivatives by s. orthogonal: see
    `moment_components`.
    """
    torques = ca.SX.zeros(character.n_angles)
    share = character.mass / MEASURED_MASS
    for body, joint in zip(character.bodies, character.joints, strict=True):
        tissue = PASSIVE_JOINTS.get(body.part)
        if tissue is None or joint.parent < 0:
            continue
        before, neutral = ca.SX(joint.axes.before), ca.SX(neutral_rotation(body))
        R, omega, angles = before, ca.SX.zeros(3), q[joint.dofs]
        for k in range(joint.axes.dofs):
            omega += R[:, k] * v[joint.first + k]
            R = times_axis_rotation(R, k, angles[k])
        R = R @ ca.SX(joint.axes.after)
        away = 0.5 * sum((ca.cross(neutral[:, k], R[:, k]) for k in range(3)), ca.SX.zeros(3))
        moment = -share * (tissue.stiffness * away + tissue.damping * omega)
        torques[joint.dofs] = moment_components(before, angles, moment, orthogonal=orthogonal)
    return torques


class PassiveTorques:
    """Passive torques at some angles (m,), N·m, about orthogonal axes, and their derivatives."""

    def __init__(self, character: Character, angles: IntArray) -> None:
        n = self._n = character.n_angles
        x = ca.SX.sym("x", 2 * n)
        torques = passive_torques(character, x[:n], x[n:], orthogonal=True)[angles.tolist()]
        self._value = BatchFunction("passive", x, [torques])
        self._by = BatchFunction("passive_by", x, [ca.jacobian(torques, x)])

    def value(self, q: FloatArray, v: FloatArray) -> FloatArray:
        """(T, m) at joint angles (T, n_angles), rad, and their derivatives by s."""
        (found,) = self._value(np.concatenate([q, v], axis=1))
        return found

    def derivatives(self, q: FloatArray, v: FloatArray) -> tuple[FloatArray, FloatArray]:
        """(T, m, n_angles) by angles and by speeds."""
        (found,) = self._by(np.concatenate([q, v], axis=1))
        by = np.swapaxes(found, 1, 2)
        return by[:, :, : self._n], by[:, :, self._n :]


def evaluate_passive_torques(
    character: Character, q: FloatArray, v: FloatArray, *, orthogonal: bool = False
) -> FloatArray:
    """(T, n_angles) N·m of joint angles (T, n_angles), rad, and their derivatives by s."""
    n = character.n_angles
    x = ca.SX.sym("x", 2 * n)
    torques = passive_torques(character, x[:n], x[n:], orthogonal=orthogonal)
    (found,) = BatchFunction("passive", x, [torques])(np.concatenate([q, v], axis=1))
    return found


def neutral_rotation(body: Body) -> FloatArray:
    """(3, 3) child to parent: an arm or a leg hangs along the trunk, all else is as at rest."""
    if body.part not in HANGING:
        return np.eye(3)
    along = unit(body.tip)
    across = np.cross(along, -UP)
    sine = float(np.linalg.norm(across))
    axis = across / sine if sine > 1e-9 else perpendicular(along)
    return rotation_matrix(np.arctan2(sine, -float(along @ UP)) * axis)


def times_axis_rotation(R: ca.SX, axis: int, angle: ca.SX) -> ca.SX:
    """R (3, 3) times the rotation by `angle`, rad, about coordinate axis 0, 1 or 2."""
    c, s = ca.cos(angle), ca.sin(angle)
    columns = [R[:, 0], R[:, 1], R[:, 2]]
    i, j = (axis + 1) % 3, (axis + 2) % 3
    columns[i], columns[j] = R[:, i] * c + R[:, j] * s, R[:, j] * c - R[:, i] * s
    return ca.horzcat(*columns)


def moment_components(R: ca.SX, q: ca.SX, moment: ca.SX, *, orthogonal: bool) -> ca.SX:
    """(dofs,) components of a joint's moment (3,) about the axes of its angles q (dofs,), rad.

    R: (3, 3) the joint's frame before it turns, in the moment's axes. orthogonal: the third about
    the axis across the first two, not about the third angle's, which near gimbal lock is parallel
    to the first and tells nothing of a moment across it.
    """
    axes = []
    for k in range(q.shape[0]):
        axes.append(R[:, k])
        R = times_axis_rotation(R, k, q[k])
    if orthogonal and len(axes) == 3:
        axes[2] = ca.cross(axes[0], axes[1])
    return ca.vertcat(*(ca.dot(axis, moment) for axis in axes))
