"""The price of turning a person's joints: shares of what each can do (human/ranges.py).

A joint that is turned through its whole range, whichever way, costs the same: a collarbone's 55
degrees as much as a hip's 150. The bones of a spine or a neck share its range, and cost together
what one joint would. One number is left, how much that is in metres: in the mean over the joints,
as much as they move by it, so that neither what a joint moves nor how far it turns is all.
"""

from collections.abc import Iterator
from math import atan2, cos, sin

import numpy as np

from ..arrays import FloatArray
from ..body.anatomy import Part
from ..body.character import Character
from ..body.kinematics import forward_kinematics
from ..numerics.rotations import shortest_rotation, unit
from ..objectives.joint_price import JointPrice
from ..objectives.tracking_cost import marker_points
from ..transcription.joint_measures import BendAngle, ConeAngle, SideAngle, TwistAngle
from ..transcription.motion import Motion
from .ranges import JointRange, joint_ranges

CHAINS = {Part.SPINE: "spine", Part.NECK: "neck", Part.HEAD: "neck"}  # whose bones share a range
SAMPLES = 50  # instants that tell how far joints move what they carry


def range_price(reference: Motion) -> JointPrice:
    """What turning a motion's joints costs, by the ranges that a person's have."""
    character = reference.transcription.character
    angles = reference.angles(np.linspace(0.0, reference.duration, SAMPLES))
    turns, share = np.zeros((len(character.bodies), 3, 3)), _shares(character)
    found: dict[int, list[JointRange]] = {}
    for limit in joint_ranges(character, angles):
        found.setdefault(limit.body, []).append(limit)
    for i, limits in found.items():
        turns[i] = share[i] * _by_width([way for limit in limits for way in _ways(limit)])
    price, posed = JointPrice(turns, share), forward_kinematics(character, angles)
    return price.as_dear_as_movement(posed, list(marker_points(character)))


def _shares(character: Character) -> FloatArray:
    """(B,) of a joint: 1 over the bones that share its range."""
    bones = list(zip(character.bodies, character.joints, strict=True))
    chains = [CHAINS.get(body.part) if joint.parent >= 0 else None for body, joint in bones]
    return np.array([1.0 if chain is None else 1.0 / chains.count(chain) for chain in chains])


def _by_width(ways: list[tuple[FloatArray, float]]) -> FloatArray:
    """(3, 3) price of turns about axes (3,), each over its width, rad.

    What no range tells, such as a knee's turn about itself, costs as the narrowest that is told.
    """
    axes, widths = np.stack([axis for axis, _ in ways]), [width for _, width in ways]
    rest = np.linalg.svd(axes)[2][len(axes) :]
    widths += [min(widths)] * len(rest)
    scaled = np.concatenate([axes, rest]) / np.array(widths)[:, None]
    return np.asarray(scaled.T @ scaled)


def _ways(limit: JointRange) -> Iterator[tuple[FloatArray, float]]:
    """Axes (3,) unit, in the child's frame, that a range is about, and its width there, rad."""
    measure, width = limit.measure, limit.upper - limit.lower
    match measure:
        case ConeAngle():
            carried = shortest_rotation(measure.frame[0], measure.along)
            for across, stretch in zip(measure.frame[1:], measure.stretch, strict=True):
                half = atan2(stretch * sin(limit.upper), cos(limit.upper))
                yield carried @ np.cross(measure.frame[0], across), 2.0 * half
        case BendAngle():
            yield np.cross(measure.straight, measure.flexion), width
        case SideAngle():
            yield unit(np.cross(measure.along, measure.normal)), width
        case TwistAngle():
            yield measure.zero.T @ measure.along, width
        case _:
            raise TypeError(measure)
