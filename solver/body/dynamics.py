"""Centroidal equations of motion as CasADi functions (thesis 3.2.2: the root rows).

With the centre of mass as coordinates the six root rows of the Euler-Lagrange equations fall into
    m c'' = m g + sum of contact forces              (linear; see transcription/transcription.py)
    L'(theta, theta', theta'') = sum (p_i - c) x f_i   (angular momentum about the centre of mass)
and L' depends on the joint angles alone. Forces are in body weights, so L' is in body weights x m
(thesis 4.1: scaling).
"""

from dataclasses import dataclass
from functools import cached_property

import casadi as ca
import numpy as np

from ..arrays import FloatArray
from ..data.constants import STANDARD_GRAVITY
from ..numerics.batch_function import BatchFunction
from .character import Character
from .kinematics import Pose, forward_kinematics


@dataclass(frozen=True)
class BodyMotion:
    """Motion of a body's frame as expressions, world axes.

    R: rotation, body to world. omega, alpha: angular velocity (rad/s) and acceleration (rad/s²).
    x, v, a: position, velocity, acceleration of its joint's centre from the root's, m, s.
    """

    R: ca.SX
    omega: ca.SX
    alpha: ca.SX
    x: ca.SX
    v: ca.SX
    a: ca.SX


def point_motion(frame: BodyMotion, local: ca.SX) -> tuple[ca.SX, ca.SX, ca.SX]:
    """Position, velocity, acceleration (3,) of a body-fixed point, world axes, from the root."""
    arm = frame.R @ local
    swing = ca.cross(frame.omega, arm)
    return (
        frame.x + arm,
        frame.v + swing,
        frame.a + ca.cross(frame.alpha, arm) + ca.cross(frame.omega, swing),
    )


def body_frames(character: Character, q: ca.SX, v: ca.SX, a: ca.SX) -> list[BodyMotion]:
    """Forward pass of the recursive Newton-Euler algorithm (Featherstone 2008, ch. 5.3).

    q, v, a: (n_angles,) joint angles, rad, and their first two derivatives by s. One per body.
    """
    zero = ca.SX.zeros(3)
    ground = BodyMotion(ca.SX.eye(3), zero, zero, zero, zero, zero)
    frames: list[BodyMotion] = []
    for joint in character.joints:
        parent = frames[joint.parent] if joint.parent >= 0 else ground
        x, xv, xa = point_motion(parent, ca.SX(joint.offset))
        R = parent.R @ ca.SX(joint.axes.before)
        omega, alpha = parent.omega, parent.alpha
        for k in range(joint.axes.dofs):
            i = joint.first + k
            axis = R[:, k]
            alpha = alpha + axis * a[i] + ca.cross(omega, axis * v[i])
            omega = omega + axis * v[i]
            R = times_axis_rotation(R, k, q[i])
        frames.append(BodyMotion(R @ ca.SX(joint.axes.after), omega, alpha, x, xv, xa))
    return frames


def times_axis_rotation(R: ca.SX, axis: int, angle: ca.SX) -> ca.SX:
    """R (3, 3) times the rotation by `angle`, rad, about coordinate axis 0, 1 or 2."""
    c, s = ca.cos(angle), ca.sin(angle)
    columns = [R[:, 0], R[:, 1], R[:, 2]]
    i, j = (axis + 1) % 3, (axis + 2) % 3
    columns[i], columns[j] = R[:, i] * c + R[:, j] * s, R[:, j] * c - R[:, i] * s
    return ca.horzcat(*columns)


class MomentFunction:
    """Rate of centroidal angular momentum L', body weights x m, and its Jacobian, vectorised."""

    def __init__(self, character: Character) -> None:
        n = character.n_angles
        self.n = n
        q, v, a = ca.SX.sym("q", n), ca.SX.sym("v", n), ca.SX.sym("a", n)
        rate = momentum_rate(character, q, v, a) / (character.mass * STANDARD_GRAVITY)
        x = ca.vertcat(q, v, a)
        self._character, self._rate = character, MomentumRate(character)
        # No ca.cse: it takes 0.4 s here and saves 3 % of the instructions.
        self._both = BatchFunction("moment_jacobian", x, [rate, ca.jacobian(rate, x)])

    def value(self, q: FloatArray, v: FloatArray, a: FloatArray) -> FloatArray:
        """(N, 3) L', world axes, at (N, n_angles) angles, velocities, accelerations (rad, s)."""
        return self.value_at(forward_kinematics(self._character, q), v, a)

    def value_at(self, posed: Pose, v: FloatArray, a: FloatArray) -> FloatArray:
        """(N, 3) the same at poses that are known."""
        return self._rate(posed, v, a) / (self._character.mass * STANDARD_GRAVITY)

    def jacobian(
        self, q: FloatArray, v: FloatArray, a: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """L' (N, 3) and its derivatives (N, 3, 3, n_angles): component, by q, v or a, angle."""
        x = np.concatenate([q, v, a], axis=1)
        rate, jacobian = self._both(x)
        by_order = np.swapaxes(jacobian, 1, 2).reshape(len(x), 3, 3, self.n)
        return rate, by_order


def momentum_rate(character: Character, q: ca.SX, v: ca.SX, a: ca.SX) -> ca.SX:
    """(3,) rate of change of the angular momentum about the centre of mass, N·m, world axes.

    q, v, a: (n_angles,) rad, s. Sum over bodies of r x m a + I alpha + omega x I omega
    (Newton-Euler; thesis 3.2.2; Orin, Goswami and Lee 2013).
    """
    frames = body_frames(character, q, v, a)
    moving = []
    centre = ca.SX.zeros(3)
    for frame, body in zip(frames, character.bodies, strict=True):
        x, _, acceleration = point_motion(frame, ca.SX(body.com))
        moving.append((x, acceleration))
        centre += body.mass / character.mass * x
    rate = ca.SX.zeros(3)
    for (x, acceleration), frame, body in zip(moving, frames, character.bodies, strict=True):
        inertia = frame.R @ ca.SX(body.inertia) @ frame.R.T
        spin = inertia @ frame.alpha + ca.cross(frame.omega, inertia @ frame.omega)
        rate += ca.cross(x - centre, body.mass * acceleration) + spin
    return rate


@dataclass(frozen=True)
class MomentumRate:
    """L' of a character's motions from their poses, which most who ask for it have already.

    Newton-Euler over long arrays, vectors being (..., 3, N): a fifth of what CasADi takes.
    """

    character: Character

    @cached_property
    def _bodies_before(self) -> list[int]:
        """Of each body the one that it hangs on; -1 of the root."""
        return [joint.parent for joint in self.character.joints]

    @cached_property
    def _last_angle(self) -> list[int]:
        """Of each body the last angle that turns it."""
        last: list[int] = []
        for joint in self.character.joints:
            last.append(joint.dofs.stop - 1 if joint.axes.dofs else last[joint.parent])
        return last

    @cached_property
    def _angles_before(self) -> list[int]:
        """Of each angle the one before it on the way from the root; -1 of the first."""
        before = np.arange(self.character.n_angles) - 1
        for joint in self.character.joints[1:]:
            if joint.axes.dofs:
                before[joint.first] = self._last_angle[joint.parent]
        return [int(each) for each in before]

    @cached_property
    def _masses(self) -> FloatArray:
        return np.array([body.mass for body in self.character.bodies])[:, None, None]

    @cached_property
    def _inertias(self) -> FloatArray:
        """(B, 3, 3, 1) kg m², about the centres of mass."""
        return np.stack([body.inertia for body in self.character.bodies])[..., None]

    def __call__(self, posed: Pose, speeds: FloatArray, accelerations: FloatArray) -> FloatArray:
        """(N, 3) L', N·m, world axes, at poses with angles' derivatives (N, n_angles) rad, s.

        Sum over bodies of r x m a + I alpha + omega x I omega (Featherstone 2008, ch. 5.3).
        Accelerations are from the root's centre: what all bodies share has no moment about the
        centre of mass.
        """
        axes, centres, coms = (
            _instants_last(v) for v in (posed.axes, posed.centres, posed.body_coms)
        )
        turn = axes * speeds.T[:, None]
        turned = _summed(turn, self._angles_before)
        gained = axes * accelerations.T[:, None] + _cross(turned - turn, turn)
        omega, alpha = (
            turned[self._last_angle],
            _summed(gained, self._angles_before)[self._last_angle],
        )
        above = np.maximum(self._bodies_before, 0)
        hung = _swung(omega[above], alpha[above], centres - centres[above])
        carried = _summed(hung, self._bodies_before) + _swung(omega, alpha, coms - centres)
        R = _instants_last(posed.rotations)
        omega, alpha = (_times(R.swapaxes(1, 2), each) for each in (omega, alpha))
        spin = _times(self._inertias, alpha) + _cross(omega, _times(self._inertias, omega))
        moment = _cross(coms, self._masses * carried) + _times(R, spin)
        return np.asarray(moment.sum(axis=0).T)


def _instants_last(each: FloatArray) -> FloatArray:
    """(..., N) of (N, ...)."""
    return np.ascontiguousarray(np.moveaxis(each, 0, -1))


def _summed(each: FloatArray, before: list[int]) -> FloatArray:
    """Sums (K, 3, N) along a tree from its root; before: of each its parent, -1 of the root."""
    total = each.copy()
    for i, parent in enumerate(before):
        if parent >= 0:
            total[i] += total[parent]
    return total


def _times(matrices: FloatArray, vectors: FloatArray) -> FloatArray:
    """(B, 3, N) products of matrices (B, 3, 3, N) with vectors (B, 3, N)."""
    columns = (matrices[:, :, k] * vectors[:, k, None] for k in range(3))
    return np.asarray(sum(columns))


def _swung(omega: FloatArray, alpha: FloatArray, arm: FloatArray) -> FloatArray:
    """Acceleration of arms' ends from their beginnings."""
    return _cross(alpha, arm) + _cross(omega, _cross(omega, arm))


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """Cross products (K, 3, N) over the middle axis."""
    parts = [a[:, i - 2] * b[:, i - 1] - a[:, i - 1] * b[:, i - 2] for i in range(3)]
    return np.stack(parts, axis=1)
