"""Joint torques as functions of the unknowns (thesis 3.2: the rows of the actuated joints).

Torques are not unknowns of their own: by the equations of motion they follow from movement and
contact forces, at every instant exactly. So the rows of the joints that a problem names are
evaluated where it needs them, and the standard, intermediate and reduced formulations differ
only in which joints' torques are bounded or weighed (docs/design.md says why).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import casadi as ca
import numpy as np

from ..arrays import FloatArray, IntArray
from ..body.character import Character
from ..body.dynamics import evaluate
from ..body.inverse_dynamics import inverse_dynamics
from ..body.kinematics import BodyPoint
from ..data.constants import STANDARD_GRAVITY
from ..data.row_kinds import RowKind
from .sampling import Channel, Slope, State
from .transcription import Transcription


class TorqueFunction:
    """Torques at chosen joint angles, body weights x m, and their derivatives.

    angles: (m,) indices of joint angles, none of the root's.
    """

    def __init__(
        self, character: Character, points: Sequence[BodyPoint], angles: Sequence[int] | IntArray
    ) -> None:
        n = character.n_angles
        self.angles = np.asarray(angles, dtype=int)
        self._n, self._n_points = n, len(points)
        q, v, a = ca.SX.sym("q", n), ca.SX.sym("v", n), ca.SX.sym("a", n)
        fall = ca.SX.sym("fall", 3)
        forces = ca.SX.sym("forces", 3, len(points))
        weight = character.mass * STANDARD_GRAVITY
        every = inverse_dynamics(character, points, q, v, a, fall, weight * forces)
        torques = every[(self.angles + 3).tolist()] / weight
        x = ca.vertcat(q, v, a, fall, ca.vec(forces))
        jacobian = ca.densify(ca.jacobian(torques, x))
        self._value = ca.Function("torques", [x], [ca.densify(torques)])
        self._both = ca.Function("torques_by", [x], [ca.densify(torques), jacobian])
        self._width = int(x.shape[0])

    def value(self, state: State) -> FloatArray:
        """(U, m)."""
        (torques,) = evaluate(self._value, self._inputs(state), [(len(self.angles),)])
        return torques

    def slopes(self, state: State) -> list[Slope]:
        """Derivatives by angles, speeds, accelerations, the centre of mass's and forces."""
        m = len(self.angles)
        shapes = [(m,), (self._width, m)]
        by = np.swapaxes(evaluate(self._both, self._inputs(state), shapes)[1], 1, 2)
        n = self._n
        slopes = [Slope(Channel.ANGLES, k, by[:, :, k * n : (k + 1) * n]) for k in range(3)]
        slopes.append(Slope(Channel.COM, 2, by[:, :, 3 * n : 3 * n + 3]))
        if self._n_points:
            slopes.append(Slope(Channel.FORCES, 0, by[:, :, 3 * n + 3 :]))
        return slopes

    def _inputs(self, state: State) -> FloatArray:
        parts = [state.angles(0), state.angles(1), state.angles(2), state.com(2)]
        return np.concatenate([*parts, state.forces.reshape(len(parts[0]), -1)], axis=1)


def every_torque(transcription: Transcription) -> TorqueFunction:
    """The torques of every joint."""
    character = transcription.character
    return TorqueFunction(character, transcription.points, range(3, character.n_angles))


@dataclass(frozen=True)
class Torques:
    """Torques as a measure that can be bounded."""

    function: TorqueFunction
    kind: RowKind = RowKind.TORQUE

    def value(self, state: State) -> FloatArray:
        return self.function.value(state)

    def slopes(self, state: State) -> list[Slope]:
        return self.function.slopes(state)
