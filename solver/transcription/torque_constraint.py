"""Joint torques as functions of the unknowns (thesis 3.2: the rows of the actuated joints).

Torques are not unknowns of their own: by the equations of motion they follow from movement and
contact forces, at every instant exactly. So the rows of the joints that a problem names are
evaluated where it needs them, and the standard, intermediate and reduced formulations differ
only in which joints' torques are bounded or weighed (docs/design.md says why).
"""

from collections.abc import Sequence

import numpy as np

from ..arrays import FloatArray, IntArray
from ..body.character import Character
from ..body.inverse_dynamics import JointTorques, Movement
from ..body.kinematics import BodyPoint
from ..body.passive_joints import PassiveTorques
from ..data.constants import STANDARD_GRAVITY
from ..data.row_kinds import RowKind
from .rows import ROOT_ANGLES
from .sampling import Channel, ChannelJacobian, State
from .transcription import Transcription


class TorqueFunction:
    """Joint torques (U, m) in body weights x m, a constraint function.

    angles: (m,) indices of joint angles, none of the root's. points: where contact forces act.
    of_muscles: without the share that passive tissue gives (body/passive_joints.py), and about
    orthogonal axes, so that a bound on each bounds the moment (body/inverse_dynamics.py).
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
        self.angles = np.asarray(angles, dtype=int)
        self._character, self._points = character, points
        self._torques = JointTorques(character, points, self.angles, orthogonal=of_muscles)
        self._weight = character.mass * STANDARD_GRAVITY
        self._tissue = PassiveTorques(character, self.angles) if of_muscles else None

    def value(self, state: State) -> FloatArray:
        """(U, m) body weights x m."""
        torques = self._torques.value(self._movement(state))
        if self._tissue is not None:
            torques -= self._tissue.value(state.angles(), state.angles(1))
        return torques / self._weight

    def jacobians(self, state: State) -> list[ChannelJacobian]:
        """By angles, angular velocities, accelerations, the centre of mass's, and forces."""
        found = self._torques.derivatives(self._movement(state))
        by_angles = [found.by_angle, found.by_speed, found.by_acceleration]
        if self._tissue is not None:
            tissue = self._tissue.derivatives(state.angles(), state.angles(1))
            for each, passive in zip(by_angles, tissue, strict=False):
                each -= passive
        jacobians = [
            ChannelJacobian(Channel.ANGLES, k, each / self._weight)
            for k, each in enumerate(by_angles)
        ]
        jacobians.append(ChannelJacobian(Channel.COM, 2, found.by_com_acceleration / self._weight))
        if self._points:
            by_force = found.by_force.reshape(*found.by_force.shape[:2], -1)  # of body weights
            jacobians.append(ChannelJacobian(Channel.FORCES, 0, by_force))
        return jacobians

    def _movement(self, state: State) -> Movement:
        forces = self._weight * state.forces
        return Movement(state.pose, state.angles(1), state.angles(2), state.com(2), forces)


def joint_torques(transcription: Transcription) -> TorqueFunction:
    """The torques of every actuated joint."""
    character = transcription.character
    return TorqueFunction(character, transcription.points, range(ROOT_ANGLES, character.n_angles))
