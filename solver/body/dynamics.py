"""The equations of motion as CasADi functions (thesis 3.2.2: the root rows).

With the centre of mass as coordinates the six root rows of the Euler-Lagrange equations fall into
    m c'' = m g + sum of contact forces              (linear; see transcription.py)
    L'(theta, theta', theta'') = sum (p_i - c) x f_i   (angular momentum about the centre of mass)
and L' depends on the joint angles alone. Forces are in body weights, so L' is in body weights x m
(thesis 4.1: scaling).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np

from ..arrays import FloatArray
from ..numerics.parallel import in_threads
from .character import Character

GRAVITY = 9.81
FEWEST_EACH = 32  # instants worth a thread of their own


@dataclass(frozen=True)
class Moving:
    """A body's frame as expressions: rotation, angular velocity and acceleration, and of its
    joint's centre position, velocity and acceleration relative to the pelvis's centre."""

    R: ca.SX
    omega: ca.SX
    alpha: ca.SX
    x: ca.SX
    v: ca.SX
    a: ca.SX


def carried(frame: Moving, local: ca.SX) -> tuple[ca.SX, ca.SX, ca.SX]:
    """Position, velocity, acceleration of a point fixed in a moving body."""
    arm = frame.R @ local
    swing = ca.cross(frame.omega, arm)
    return (
        frame.x + arm,
        frame.v + swing,
        frame.a + ca.cross(frame.alpha, arm) + ca.cross(frame.omega, swing),
    )


def body_frames(character: Character, q: ca.SX, v: ca.SX, a: ca.SX) -> list[Moving]:
    """Kinematics from the root outwards (Featherstone 2008, ch. 5.3, forward pass)."""
    zero = ca.SX.zeros(3)
    ground = Moving(ca.SX.eye(3), zero, zero, zero, zero, zero)
    frames: list[Moving] = []
    for joint in character.joints:
        parent = frames[joint.parent] if joint.parent >= 0 else ground
        x, xv, xa = carried(parent, ca.SX(joint.offset))
        R = parent.R @ ca.SX(joint.axes.before)
        omega, alpha = parent.omega, parent.alpha
        for k in range(joint.axes.dofs):
            i = joint.first + k
            axis = R[:, k]
            alpha = alpha + axis * a[i] + ca.cross(omega, axis * v[i])
            omega = omega + axis * v[i]
            R = turned(R, k, q[i])
        frames.append(Moving(R @ ca.SX(joint.axes.after), omega, alpha, x, xv, xa))
    return frames


def turned(R: ca.SX, axis: int, angle: ca.SX) -> ca.SX:
    """R times the rotation by `angle` about coordinate axis `axis`: mixes two columns."""
    c, s = ca.cos(angle), ca.sin(angle)
    columns = [R[:, 0], R[:, 1], R[:, 2]]
    i, j = (axis + 1) % 3, (axis + 2) % 3
    columns[i], columns[j] = R[:, i] * c + R[:, j] * s, R[:, j] * c - R[:, i] * s
    return ca.horzcat(*columns)


class MomentFunction:
    """L' about the centre of mass, in body weights x m, and its Jacobian at many instants."""

    def __init__(self, character: Character) -> None:
        n = character.n_angles
        self.n = n
        q, v, a = ca.SX.sym("q", n), ca.SX.sym("v", n), ca.SX.sym("a", n)
        rate = momentum_rate(character, q, v, a) / (character.mass * GRAVITY)
        x = ca.vertcat(q, v, a)
        jacobian = ca.densify(ca.jacobian(rate, x))
        # No ca.cse: it takes 0.4 s here and saves 3 % of the instructions.
        self._value = ca.Function("moment", [x], [ca.densify(rate)])
        self._both = ca.Function("moment_jacobian", [x], [ca.densify(rate), jacobian])

    def value(self, q: FloatArray, v: FloatArray, a: FloatArray) -> FloatArray:
        """(N, 3) L' at (N, n_angles) angles, velocities, accelerations."""
        x = np.concatenate([q, v, a], axis=1)
        (rate,) = evaluate(self._value, x, [(3,)])
        return rate

    def jacobian(
        self, q: FloatArray, v: FloatArray, a: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """L' (N, 3) and its derivatives (N, 3, 3, n_angles): row, by q, v or a, angle."""
        x = np.concatenate([q, v, a], axis=1)
        rate, jacobian = evaluate(self._both, x, [(3,), (3 * self.n, 3)])
        by_order = np.swapaxes(jacobian, 1, 2).reshape(len(x), 3, 3, self.n)
        return rate, by_order


def momentum_rate(character: Character, q: ca.SX, v: ca.SX, a: ca.SX) -> ca.SX:
    """(3,) rate of change of the angular momentum about the centre of mass, N·m."""
    frames = body_frames(character, q, v, a)
    moving = []
    centre = ca.SX.zeros(3)
    for frame, body in zip(frames, character.bodies, strict=True):
        x, _, acceleration = carried(frame, ca.SX(body.com))
        moving.append((x, acceleration))
        centre += body.mass / character.mass * x
    rate = ca.SX.zeros(3)
    for (x, acceleration), frame, body in zip(moving, frames, character.bodies, strict=True):
        inertia = frame.R @ ca.SX(body.inertia) @ frame.R.T
        spin = inertia @ frame.alpha + ca.cross(frame.omega, inertia @ frame.omega)
        rate += ca.cross(x - centre, body.mass * acceleration) + spin
    return rate


def evaluate(
    function: ca.Function, x: FloatArray, shapes: Sequence[tuple[int, ...]]
) -> list[FloatArray]:
    """Dense outputs (N, *shape) of a one-input function at every row of x (N, n).

    CasADi stores columns first, so a matrix output of r rows and c columns has shape (c, r) here.
    """
    inputs = np.ascontiguousarray(x, dtype=float)
    outputs = [np.empty((len(x), *shape)) for shape in shapes]
    # Plain threads: CasADi's own threaded map was slower than the serial one.
    in_threads(
        lambda part: _fill(function, inputs[part], [out[part] for out in outputs]),
        len(x),
        FEWEST_EACH,
    )
    return outputs


def _fill(function: ca.Function, inputs: FloatArray, outputs: Sequence[FloatArray]) -> None:
    """Evaluates into the given memory, without the conversions that would cost more than it."""
    buffer: Any  # CasADi's stubs give its methods C's arguments
    buffer, run = function.map(len(inputs)).buffer()
    buffer.set_arg(0, inputs.data)
    for i, out in enumerate(outputs):
        buffer.set_res(i, out.data)
    run()
