"""Newton-Euler in CasADi expressions, as a first-time user of CasADi writes it: what our arrays are
measured and tested against."""

from collections.abc import Sequence
from dataclasses import dataclass

import casadi as ca

from ...solver.body.character import Character
from ...solver.body.kinematics import BodyPoint
from ...solver.body.passive_joints import moment_components, times_axis_rotation


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
class _Wrench:
    """Wrench: force, and moment about a point at x (3,)."""

    x: ca.SX
    force: ca.SX
    moment: ca.SX

    def about(self, x: ca.SX) -> ca.SX:
        """Moment about another point."""
        return self.moment + ca.cross(self.x - x, self.force)


def inverse_dynamics(
    character: Character,
    points: Sequence[BodyPoint],
    q: ca.SX,
    v: ca.SX,
    a: ca.SX,
    com_acceleration: ca.SX,
    forces: ca.SX,
    *,
    orthogonal: bool = False,
) -> ca.SX:
    """(6 + n_angles - 3,) residual force and moment at the root, then joint torques, N, N·m.

    Newton-Euler per body, wrenches summed from the leaves inwards (Featherstone 2008, ch. 5.3,
    backward pass). q, v, a: (n_angles,) rad, s. com_acceleration: (3,) m/s², forces: (3, P) N on
    the body at `points`; both in world axes. The root's moment is about the centre of mass.
    orthogonal: see `moment_components`.
    """
    frames = body_frames(character, q, v, a)
    moving = [point_motion(f, ca.SX(b.com)) for f, b in zip(frames, character.bodies, strict=True)]
    shares = [body.mass / character.mass for body in character.bodies]
    com = sum((s * m[0] for s, m in zip(shares, moving, strict=True)), ca.SX.zeros(3))
    com_drift = sum((s * m[2] for s, m in zip(shares, moving, strict=True)), ca.SX.zeros(3))
    wrenches: list[_Wrench] = []  # that each body and all beyond it need, about its joint
    for frame, body, (x, _, acceleration) in zip(frames, character.bodies, moving, strict=True):
        force = body.mass * (
            com_acceleration - com_drift + acceleration + ca.SX([0.0, 0.0, character.gravity])
        )
        inertia = frame.R @ ca.SX(body.inertia) @ frame.R.T
        spin = inertia @ frame.alpha + ca.cross(frame.omega, inertia @ frame.omega)
        wrenches.append(_Wrench(frame.x, force, spin + ca.cross(x - frame.x, force)))
    for p, point in enumerate(points):
        held = wrenches[point.body]
        at = point_motion(frames[point.body], ca.SX(point.place))[0]
        push = _Wrench(at, -forces[:, p], ca.SX.zeros(3))
        wrenches[point.body] = _sum(held, push)
    torques = ca.SX.zeros(character.n_angles)
    for i in reversed(range(1, len(character.joints))):
        joint = character.joints[i]
        R = frames[joint.parent].R @ ca.SX(joint.axes.before)
        moment, angles = wrenches[i].moment, q[joint.dofs]
        torques[joint.dofs] = moment_components(R, angles, moment, orthogonal=orthogonal)
        wrenches[joint.parent] = _sum(wrenches[joint.parent], wrenches[i])
    return ca.vertcat(wrenches[0].force, wrenches[0].about(com), torques[3:])


def _sum(held: _Wrench, added: _Wrench) -> _Wrench:
    """Sum of two wrenches, about the first one's point."""
    return _Wrench(held.x, held.force + added.force, held.moment + added.about(held.x))
