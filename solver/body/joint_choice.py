"""Which joint a part of the body has: degrees of freedom, and the axes that are expected of it.

The search for axes that keep a clip from gimbal lock is joint_axes.py's; it starts from these.
"""

from collections.abc import Mapping

import numpy as np

from ..arrays import FloatArray
from ..data.constants import UP
from ..numerics.rotations import shortest_rotation, unit
from .anatomy import Part, Segment, Side
from .joint_axes import JointAxes, ball_axes, hinge_axes, residual_angle, universal_axes

JOINT_DOFS: Mapping[Part, int] = {
    Part.SHANK: 1,
    Part.TOE: 1,
    Part.FOREARM: 1,
    Part.FOOT: 2,
    Part.CLAVICLE: 2,
    Part.HAND: 2,
}  # every other part has 3
EXTENDABLE_JOINTS = (Part.FOREARM, Part.FOOT, Part.CLAVICLE, Part.HAND)
MAX_JOINT_RESIDUAL = np.radians(4.0)  # RMS; beyond it an extendable joint gets another DOF
MIN_BONE_LENGTH = 1e-4  # m; a shorter bone has no direction


def own_directions(segment: Segment, tip: FloatArray, forward: FloatArray) -> FloatArray:
    """(3, 3) columns left, ahead, up as a body has them: of an arm's, as if it rested level.

    Some rigs rest with their arms level, others with them lowered: the joints are the same.
    """
    sideways = np.cross(UP, forward)
    frame: FloatArray = np.stack([sideways, forward, UP], axis=1)
    if segment.part not in (Part.UPPER_ARM, Part.FOREARM, Part.HAND):
        return frame
    outwards = sideways if segment.side is Side.LEFT else -sideways
    return np.asarray(shortest_rotation(outwards, unit(tip)) @ frame)


def chosen_axes(
    segment: Segment,
    relative: FloatArray,
    tip: FloatArray,
    above: FloatArray | None,
    frame: FloatArray,
) -> JointAxes:
    """Joint axes of a segment from its rotations (T, 3, 3) to its parent.

    above, frame: (3, 3) own directions of parent and segment; above is None for the root.
    """
    sideways, _, up = frame.T
    if above is None:
        return ball_axes(relative, (UP, sideways), (frame, frame))
    along = unit(tip) if np.linalg.norm(tip) > MIN_BONE_LENGTH else UP
    hinge = sideways if abs(float(sideways @ along)) < 0.8 else up  # arms point sideways
    dofs = JOINT_DOFS.get(segment.part, 3)
    grow = segment.part in EXTENDABLE_JOINTS
    if dofs == 1:
        axes = hinge_axes(relative, hinge)
        if not grow or residual_angle(axes, relative) < MAX_JOINT_RESIDUAL:
            return axes
        dofs = 2
    if dofs == 2:
        other = along if segment.part in (Part.FOREARM, Part.FOOT) else np.cross(along, hinge)
        pair = (hinge, unit(other))
        # Palms face down where arms are level: there wrists fold about the way ahead.
        axes = universal_axes(relative, pair[::-1] if segment.part is Part.HAND else pair)
        if not grow or residual_angle(axes, relative) < MAX_JOINT_RESIDUAL:
            return axes
    return ball_axes(relative, frames=(above, frame))
