"""The distance of motions near one of them: its tracking cost to itself, and the metric of that."""

import numpy as np

from ..arrays import BoolArray
from ..body.kinematics import forward_kinematics
from ..numerics.block_banded import BlockBanded
from ..transcription.motion import Motion
from .cost_to_go import EndTarget
from .joint_price import JointPrice
from .tracking_cost import CostWeights, TrackingCost, TrackingTarget, marker_points


def motion_metric(
    motion: Motion,
    weights: CostWeights,
    price: JointPrice | None = None,
    resting: BoolArray | None = None,
    into: BlockBanded | None = None,
) -> BlockBanded:
    """Metric W at a motion: Gauss-Newton Hessian of the tracking cost to itself.

    price, resting: as of the cost. into: an earlier Hessian or metric, to be overwritten.
    """
    cost = TrackingCost(motion.transcription, motion_target(motion), weights, price, resting)
    return cost.expand(motion.x, into)[1]


def motion_target(motion: Motion) -> TrackingTarget:
    """A motion as a tracking target."""
    t = motion.transcription
    com = t.basis.combine(motion.x[:, t.layout.com], t.node_times)
    q, a = (t.angles_at_nodes(motion.x, k) for k in (0, 2))
    markers = forward_kinematics(t.character, q).points(marker_points(t.character)) + com[:, None]
    com_acceleration = t.basis.combine(motion.x[:, t.layout.com], t.node_times, 2)
    level = np.zeros((t.basis.n_coefficients, 2))
    forces = motion.x[:, t.layout.forces]
    return TrackingTarget(markers, com, q, a, com_acceleration, forces, level, _ends(motion))


def _ends(motion: Motion) -> EndTarget:
    """A motion's first and last instant as a target."""
    t = motion.transcription
    times, points = t.basis.breaks[[0, -1]], marker_points(t.character)
    value, rate = (t.basis.combine(motion.x[:, t.layout.motion], times, k) for k in (0, 1))
    relative = forward_kinematics(t.character, value[:, t.layout.angles]).points(points)
    com = t.layout.com
    return EndTarget(relative + value[:, None, com], rate[:, com], rate[:, t.layout.angles])
