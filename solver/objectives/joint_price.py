"""What turning joints costs beside what it moves: small turns, measured by what each joint can do.

By what it moves alone, the joints nearest to the point that is asked for are the cheapest: they
carry the least. So a change is also measured by the range that it takes of its joint (Liégeois
1977; the weighted least norm of Chan & Dubey 1995).
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from ..body.kinematics import BodyPoint, Pose


@dataclass(frozen=True)
class JointPrice:
    """Price of small turns of each body's joint: t' turns t for a turn t (3,) rad in its own frame.

    turns: (B, 3, 3) m²/rad², or in any unit before `as_dear_as_movement`; zero where turning is
    free, as for the root. share: (B,) of an anatomical joint that the body's joint is.
    """

    turns: FloatArray
    share: FloatArray

    def metric(self, posed: Pose) -> FloatArray:
        """(N, n_angles, n_angles) metric of the joint angles at poses, as `turns` is."""
        n, angles = posed.axes.shape[:2]
        metric = np.zeros((n, angles, angles))
        for i, joint in enumerate(posed.character.joints):
            own = posed.axes[:, joint.dofs] @ posed.rotations[:, i]  # (N, dofs, 3) in its frame
            metric[:, joint.dofs, joint.dofs] = own @ self.turns[i] @ np.swapaxes(own, 1, 2)
        return metric

    def as_dear_as_movement(self, posed: Pose, points: list[BodyPoint]) -> "JointPrice":
        """The same in m²/rad²: of an anatomical joint's turn that costs 1 in any direction, the
        price is in the mean over joints and poses what it moves, a mean square over points."""
        turn, price = posed.point_jacobian(points), self.metric(posed)
        moved, count = 0.0, 0.0
        for i, joint in enumerate(posed.character.joints):
            if not self.turns[i].any():
                continue
            flat = turn[..., joint.dofs].reshape(len(turn), -1, joint.axes.dofs)
            square = np.swapaxes(flat, 1, 2) @ flat / len(points)
            alike = np.linalg.pinv(price[:, joint.dofs, joint.dofs], hermitian=True) @ square
            moved += float(np.trace(alike, axis1=1, axis2=2).mean())
            count += self.share[i] * joint.axes.dofs
        return JointPrice(moved / count * self.turns, self.share)
