"""Joint torques as functions of the unknowns (thesis 3.2: the rows of the actuated joints).

Torques are not unknowns of their own: by the equations of motion they follow from movement and
contact forces, at every instant exactly. So the rows of the joints that a problem names are
evaluated where it needs them, and the standard, intermediate and reduced formulations differ
only in which joints' torques are bounded or weighed (docs/design.md says why).
"""

from collections.abc import Sequence

import casadi as ca
import numpy as np

from ..arrays import FloatArray, IntArray
from ..body.character import Character
from ..body.inverse_dynamics import inverse_dynamics
from ..body.kinematics import BodyPoint
from ..body.passive_joints import passive_torques
from ..data.constants import STANDARD_GRAVITY
from ..data.row_kinds import RowKind
from ..numerics.batch_function import BatchFunction
from .rows import ROOT_ANGLES
from .sampling import Channel, ChannelJacobian, State
from .transcription import Transcription

ROOT_FORCES = 3  # rows of inverse dynamics before the moments


class TorqueFunction:
    """Joint torques (U, m) in body weights x m, a constraint function.

    angles: (m,) indices of joint angles, none of the root's. points: where contact forces act.
    of_muscles: without the share that passive tissue gives (body/passive_joints.py), and about
    orthogonal axes, so that a bound on each bounds the moment (inverse_dynamics.py).
    """

    kind = RowKind.TORQUE

    def __init__(
        self,
        character: Character,
        points: Sequence[BodyPoint],
        angles: Sequence[int] | IntArray,
        *,
        of_muscles: bool = False,
    ) -> None:
        n = character.n_angles
        self.angles = np.asarray(angles, dtype=int)
        self._n, self._n_points = n, len(points)
        q, v, a = ca.SX.sym("q", n), ca.SX.sym("v", n), ca.SX.sym("a", n)
        fall = ca.SX.sym("fall", 3)
        forces = ca.SX.sym("forces", 3, len(points))
        weight = character.mass * STANDARD_GRAVITY
        pushes = weight * forces
        every = inverse_dynamics(character, points, q, v, a, fall, pushes, orthogonal=of_muscles)
        torques = every[(self.angles + ROOT_FORCES).tolist()] / weight
        if of_muscles:
            passive = passive_torques(character, q, v, orthogonal=True)
            torques -= passive[self.angles.tolist()] / weight
        x = ca.vertcat(q, v, a, fall, ca.vec(forces))
        self._value = BatchFunction("torques", x, [torques])
        self._both = BatchFunction("torques_by", x, [torques, ca.jacobian(torques, x)])

    def value(self, state: State) -> FloatArray:
        """(U, m) body weights x m."""
        (torques,) = self._value(self._inputs(state))
        return torques

    def jacobians(self, state: State) -> list[ChannelJacobian]:
        """By angles, angular velocities, accelerations, the centre of mass's, and forces."""
        n = self._n
        matrix = np.swapaxes(self._both(self._inputs(state))[1], 1, 2)
        jacobians = [
            ChannelJacobian(Channel.ANGLES, k, matrix[:, :, k * n : (k + 1) * n]) for k in range(3)
        ]
        jacobians.append(ChannelJacobian(Channel.COM, 2, matrix[:, :, 3 * n : 3 * n + 3]))
        if self._n_points:
            jacobians.append(ChannelJacobian(Channel.FORCES, 0, matrix[:, :, 3 * n + 3 :]))
        return jacobians

    def _inputs(self, state: State) -> FloatArray:
        parts = [state.angles(0), state.angles(1), state.angles(2), state.com(2)]
        return np.concatenate([*parts, state.forces.reshape(len(parts[0]), -1)], axis=1)


def joint_torques(transcription: Transcription) -> TorqueFunction:
    """The torques of every actuated joint."""
    character = transcription.character
    return TorqueFunction(character, transcription.points, range(ROOT_ANGLES, character.n_angles))
