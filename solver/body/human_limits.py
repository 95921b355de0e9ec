"""Human joint ranges of motion, as limits on a figure's bones.

The ranges are those of active motion that the American Academy of Orthopaedic Surgeons gives
(Joint Motion: Method of Measuring and Recording, 1965), as tabulated by Norkin and White
(Measurement of Joint Motion, appendix A), degrees from the anatomical position. Spine and neck
share theirs evenly among their bones. A foot's zero is its rest pose, a hand's the forearm's line.

Hinges become ranges of the bend; ball joints become cones. A hip's and a spine's cone goes through
the four ends of its table and is wider forwards than sideways; a shoulder's is the narrowest round
one about forward and outward that holds its table; wrist and neck take their largest angle.

A cone's edge is where an ellipse across its axis is seen from its apex, as wide as its half angle
tells times the stretch of each of two directions across, at right angles.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from math import acos, radians, tan

import numpy as np

from ..arrays import FloatArray
from ..data.constants import UP
from ..numerics.rotations import perpendicular, unit
from .anatomy import Part, Side

KNEE_FLEXION = (-10.0, 135.0)  # hyperextension, flexion
ELBOW_FLEXION = (0.0, 150.0)
ANKLE_FLEXION = (-50.0, 20.0)  # plantar flexion, dorsiflexion
HIP_FLEXION = (-30.0, 120.0)  # extension, flexion
HIP_ABDUCTION = (-30.0, 45.0)  # adduction, abduction
SHOULDER_FLEXION = (-60.0, 180.0)  # extension, flexion
WRIST_FLEXION = 80.0  # flexion; extension 70, to the sides 20 and 30
SPINE_FLEXION = (-25.0, 80.0)  # extension, flexion of chest and loins together
SPINE_LATERAL_FLEXION = 35.0
NECK_FLEXION = 45.0  # flexion, extension and to either side
ON_AXIS = 1e-9  # sine of the angle from a cone's axis of what has no direction across
MIN_BEND_SINE = 0.05  # a joint that bends less does not tell in which direction it bends
SIDES = (Side.LEFT, Side.RIGHT)


@dataclass(frozen=True)
class RestFigure:
    """Skeleton at rest, world axes.

    parts: the bones of each part, parents first. parents: the mapped bone above each. along: (3,)
    unit, to the next joint. left: (3,) unit.
    """

    parts: Mapping[tuple[Part, Side], tuple[str, ...]]
    parents: Mapping[str, str]
    along: Mapping[str, FloatArray]
    left: FloatArray

    @property
    def forward(self) -> FloatArray:
        """Unit, (3,), level."""
        return unit(np.cross(self.left, UP))

    def outward(self, side: Side) -> FloatArray:
        """Lateral direction: away from the body's middle, (3,) unit."""
        return self.left if side is Side.LEFT else -self.left


@dataclass(frozen=True)
class BendRange:
    """Range of a joint's bend from the straight limb, rad; see requests.AngleLimit."""

    name: str
    bone: str
    lower: float
    upper: float


@dataclass(frozen=True)
class ConeRange:
    """Cone of a bone's directions; see requests.ConeLimit."""

    name: str
    bone: str
    axis: FloatArray
    half_angle: float
    stretch: tuple[float, float] = (1.0, 1.0)


JointRange = BendRange | ConeRange


def human_ranges(figure: RestFigure) -> tuple[JointRange, ...]:
    """Limits of all joints of the table whose bones the figure has."""
    ranges: list[JointRange] = []
    for side in SIDES:
        for part, joint, make in _SIDED:
            for bone in figure.parts.get((part, side), ()):
                if bone in figure.parents:
                    ranges.append(make(f"{side.value.title()} {joint} Range", bone, side, figure))
    ranges += _chain("Spine", figure.parts.get((Part.SPINE, Side.MIDDLE), ()), figure, _vertebra)
    neck = figure.parts.get((Part.NECK, Side.MIDDLE), ())
    head = figure.parts.get((Part.HEAD, Side.MIDDLE), ())
    ranges += _chain("Neck", (*neck, *head), figure, _neck)
    return tuple(ranges)


def missing_joints(figure: RestFigure) -> tuple[str, ...]:
    """Joints of the table for which the figure has no bone, such as "left wrist"."""
    wanted = [(part, side, joint) for part, joint, _ in _SIDED for side in SIDES]
    lost = [
        f"{s.value} {joint.lower()}" for part, s, joint in wanted if (part, s) not in figure.parts
    ]
    middle = {"spine": Part.SPINE, "neck": Part.HEAD}
    return (*lost, *(n for n, part in middle.items() if (part, Side.MIDDLE) not in figure.parts))


def limit_violation(limit: JointRange, directions: FloatArray, figure: RestFigure) -> float:
    """Largest violation of a limit over a recording, rad; 0 where it holds throughout.

    directions: (T, 3) unit, the bone's against its parent, in the axes of the rest pose.
    """
    if isinstance(limit, ConeRange):
        return max(float(_outside(limit, directions, figure).max()), 0.0)
    straight = figure.along[figure.parents[limit.bone]]
    mean = directions.mean(axis=0)
    across = mean - straight * (mean @ straight)
    if np.linalg.norm(across) < MIN_BEND_SINE:
        return 0.0
    bend = np.arctan2(directions @ unit(across), directions @ straight)
    return max(limit.lower - float(bend.min()), float(bend.max()) - limit.upper, 0.0)


def _outside(limit: ConeRange, directions: FloatArray, figure: RestFigure) -> FloatArray:
    """(T,) rad outside the cone, whose cross directions are those of joint_measures.cone_angle."""
    side = figure.left - limit.axis * (figure.left @ limit.axis)
    side = unit(side) if np.linalg.norm(side) > 0.3 else perpendicular(limit.axis)
    frame = np.stack([limit.axis, side, np.cross(limit.axis, side)])
    return beyond_edge(directions @ frame.T, limit.half_angle, np.array(limit.stretch))


# ---------------------------------------------------------------- of each joint


def _bend(name: str, bone: str, table: tuple[float, float], zero: float = 0.0) -> BendRange:
    return BendRange(name, bone, zero + radians(table[0]), zero + radians(table[1]))


def _knee(name: str, bone: str, _side: Side, _figure: RestFigure) -> BendRange:
    return _bend(name, bone, KNEE_FLEXION)


def _elbow(name: str, bone: str, _side: Side, _figure: RestFigure) -> BendRange:
    return _bend(name, bone, ELBOW_FLEXION)


def _ankle(name: str, bone: str, _side: Side, figure: RestFigure) -> BendRange:
    at_rest = _angle(figure.along[bone], figure.along[figure.parents[bone]])
    return _bend(name, bone, ANKLE_FLEXION, at_rest)


def _hip(name: str, bone: str, side: Side, figure: RestFigure) -> ConeRange:
    ahead, aside = radians(_middle(HIP_FLEXION)), radians(_middle(HIP_ABDUCTION))
    forwards = np.sin(ahead) * figure.forward - np.cos(ahead) * UP
    axis = np.cos(aside) * forwards + np.sin(aside) * figure.outward(side)
    return _elliptic(name, bone, axis, _half(HIP_ABDUCTION), _half(HIP_FLEXION))


def _shoulder(name: str, bone: str, side: Side, figure: RestFigure) -> ConeRange:
    axis = unit(figure.forward + figure.outward(side))
    ends = [np.sin(e) * figure.forward - np.cos(e) * UP for e in map(radians, SHOULDER_FLEXION)]
    widest = max(_angle(axis, end) for end in (*ends, -UP))
    return ConeRange(name, bone, axis, widest)


def _wrist(name: str, bone: str, _side: Side, figure: RestFigure) -> ConeRange:
    return ConeRange(name, bone, figure.along[figure.parents[bone]], radians(WRIST_FLEXION))


_SIDED = (
    (Part.THIGH, "Hip", _hip),
    (Part.SHANK, "Knee", _knee),
    (Part.FOOT, "Ankle", _ankle),
    (Part.UPPER_ARM, "Shoulder", _shoulder),
    (Part.FOREARM, "Elbow", _elbow),
    (Part.HAND, "Wrist", _wrist),
)


def _vertebra(name: str, bone: str, count: int, figure: RestFigure) -> ConeRange:
    tilt = radians(_middle(SPINE_FLEXION)) / count
    along = figure.along[bone]
    ahead = figure.forward - along * (figure.forward @ along)
    axis = np.cos(tilt) * along + np.sin(tilt) * unit(ahead)
    return _elliptic(name, bone, axis, SPINE_LATERAL_FLEXION / count, _half(SPINE_FLEXION) / count)


def _neck(name: str, bone: str, count: int, figure: RestFigure) -> ConeRange:
    return ConeRange(name, bone, figure.along[bone], radians(NECK_FLEXION) / count)


def _chain(
    joint: str,
    bones: Iterable[str],
    figure: RestFigure,
    make: Callable[[str, str, int, RestFigure], ConeRange],
) -> list[JointRange]:
    """Limits of bones that share a range evenly."""
    jointed = [bone for bone in bones if bone in figure.parents]
    numbers = [f" {i}" for i in range(1, len(jointed) + 1)] if len(jointed) > 1 else [""]
    return [
        make(f"{joint}{number} Range", bone, len(jointed), figure)
        for number, bone in zip(numbers, jointed, strict=False)
    ]


def _elliptic(
    name: str, bone: str, axis: FloatArray, sideways: float, forwards: float
) -> ConeRange:
    """Elliptic cone of these half-angles, degrees."""
    side, ahead = radians(sideways), radians(forwards)
    return ConeRange(name, bone, unit(axis), side, (1.0, tan(ahead) / tan(side)))


def _middle(ends: tuple[float, float]) -> float:
    return 0.5 * (ends[0] + ends[1])


def _half(ends: tuple[float, float]) -> float:
    return 0.5 * (ends[1] - ends[0])


def _angle(a: FloatArray, b: FloatArray) -> float:
    return acos(float(np.clip(a @ b, -1.0, 1.0)))


# ---------------------------------------------------------------- of a cone's edge


def off_axis(parts: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Angles (U,) rad from an axis, and ways (U, 2) unit that lead there.

    parts: (U, 3) of unit vectors, along the axis and in the two directions across.
    """
    sine = np.linalg.norm(parts[:, 1:], axis=1)
    ways = parts[:, 1:] / np.maximum(sine, ON_AXIS)[:, None]
    ways[sine < ON_AXIS] = 1.0, 0.0  # every way leads off the axis; one must do
    return np.asarray(np.arctan2(sine, parts[:, 0].copy())), ways


def narrowing(ways: FloatArray, stretch: FloatArray) -> FloatArray:
    """(U,) by what the tangent of a cone's half angle is divided, the ways (U, 2) unit across.

    stretch: (2,) of the two directions across.
    """
    return np.asarray(np.linalg.norm(ways / stretch, axis=1))


def edge(narrow: FloatArray, half_angle: FloatArray | float) -> FloatArray:
    """(U,) rad from the axis to the edge. narrow: (U,) as `narrowing` tells; half_angle: rad, of
    all or of each; of half a turn and more there is no edge."""
    bounded = np.minimum(half_angle, np.pi)
    to_it = np.arctan2(np.sin(bounded), narrow * np.cos(bounded))
    return np.where(np.asarray(half_angle) < np.pi, to_it, np.inf)


def beyond_edge(
    parts: FloatArray, half_angle: FloatArray | float, stretch: FloatArray
) -> FloatArray:
    """(U,) rad by which directions are outside a cone, straight off its axis; below 0 within.

    parts: (U, 3) of unit vectors, along the axis and in the two directions across. stretch: (2,).
    """
    angle, ways = off_axis(parts)
    return angle - edge(narrowing(ways, stretch), half_angle)
