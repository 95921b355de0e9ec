"""Ranges of every joint of a figure, as measures of its rotation with bounds.

Limbs, spine and neck as in body/human_limits.py (AAOS 1965), of which only bends and directions are
told there. What is added, degrees from the anatomical position:

rotation      of hip, shoulder, spine, neck and forearm about themselves, and of the foot about its
              length: AAOS 1965, in Norkin and White, appendix A
ankle         bends further forwards under load than free: 40, of the weight-bearing lunge
              (Bennell et al. 1998)
knee          is pushed beyond straight, but does not go there by itself (Kapandji, The Physiology
              of the Joints, volume 2): the table's 10 degrees of hyperextension do not count
collarbone    Neumann, Kinesiology of the Musculoskeletal System, chapter 5; its axial rotation by
              Inman et al. 1944. An arm raised to the full asks for 30 of elevation and 31 of
              rotation (Inman et al. 1944; Ludewig et al. 2009)
toes          the great toe's metatarsophalangeal joint, AAOS 1965
to the side   of joints that fold: an elbow's carrying angle and a knee's play under 15, a foot's
              abduction 20

A shoulder's rotation has no zero of its own: it is told with the upper arm level, half forwards and
half outwards, where zero is the forearm level and 90 the hand up.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import cos, inf, radians, sin, tan

import numpy as np

from ..arrays import FloatArray
from ..body.anatomy import Part, Side
from ..body.character import Character
from ..body.human_limits import (
    ANKLE_FLEXION,
    BendRange,
    ConeRange,
    RestFigure,
    human_ranges,
)
from ..data.constants import UP
from ..numerics.rotations import shortest_rotation, unit
from ..transcription.joint_measures import (
    ConeAngle,
    JointMeasure,
    SideAngle,
    TwistAngle,
    bend_angle,
    cone_angle,
)
from .wider_cone import wider_cone

LOADED_DORSIFLEXION = 40.0
HIP_ROTATION = (-45.0, 45.0)  # inwards, outwards
SHOULDER_ROTATION = (-70.0, 90.0)
FOREARM_ROTATION = (-80.0, 80.0)  # pronation, supination
SPINE_ROTATION = 45.0  # to either side
NECK_ROTATION = 60.0
FOOT_ROTATION = (-15.0, 35.0)  # eversion, inversion
CLAVICLE_ELEVATION = (-10.0, 45.0)  # depression, elevation
CLAVICLE_PROTRACTION = 30.0  # and retraction
CLAVICLE_ROTATION = (-10.0, 50.0)  # forwards, backwards
TOE_FLEXION = (-45.0, 70.0)  # flexion, extension
ASIDE = {Part.SHANK: 15.0, Part.FOREARM: 15.0, Part.TOE: 20.0, Part.FOOT: 20.0}
SHORTEST = 1e-3  # m; a bone that is shorter has no direction


@dataclass(frozen=True)
class JointRange:
    """Range of one measure of a body's joint, rad. name: such as "Left knee bends"."""

    name: str
    body: int
    measure: JointMeasure
    lower: float
    upper: float

    def widened(self, by: float) -> "JointRange":
        """The same, but `by` rad wider at both ends."""
        return self._wider(by, by)

    def holding(self, R: FloatArray) -> "JointRange":
        """The same, or as much wider as rotations (T, 3, 3), child to parent, ask for."""
        return self._wider(*np.maximum(self.past(R).max(axis=1), 0.0).tolist())

    def beyond(self, R: FloatArray) -> FloatArray:
        """(T,) rad beyond the range of rotations (T, 3, 3), child to parent; below 0 within."""
        return np.asarray(self.past(R).max(axis=0))

    def past(self, R: FloatArray) -> FloatArray:
        """(2, T) rad past the lower and the upper end; below 0 within. R as for `beyond`."""
        return self.measure.past(R, self.lower, self.upper)

    def _wider(self, below: float, above: float) -> "JointRange":
        """Wider by so much, rad, at each end; an elliptic cone all around, by the same angle."""
        cone = self.measure
        if isinstance(cone, ConeAngle) and np.any(cone.stretch != 1.0):
            return replace(self, measure=wider_cone(cone, self.upper, above))
        return replace(self, lower=self.lower - below, upper=self.upper + above)


def joint_ranges(character: Character, angles: FloatArray) -> tuple[JointRange, ...]:
    """Human ranges of every joint but the root's. angles: (T, n_angles) rad, of the recording or
    its fit, which tell the way that joints bend."""
    figure = rest_figure(character)
    bodies = {body.bone: i for i, body in enumerate(character.bodies)}
    found: list[JointRange] = []
    names: dict[int, str] = {}
    for limit in human_ranges(figure):
        i, name = bodies[limit.bone], limit.name.removesuffix(" Range").capitalize()
        names[i] = name
        if np.linalg.norm(character.bodies[i].tip) < SHORTEST:
            continue
        if isinstance(limit, ConeRange):
            cone = cone_angle(character, i, limit.axis, limit.stretch)
            found.append(JointRange(f"{name} bends", i, cone, -inf, limit.half_angle))
        else:
            found += _bend(character, i, name, _loaded(character, i, limit), angles)
    for i, body in enumerate(character.bodies):
        if character.joints[i].parent >= 0 and np.linalg.norm(body.tip) > SHORTEST:
            found += _more(character, figure, i, names.get(i, ""), angles)
    return tuple(found)


def rest_figure(character: Character) -> RestFigure:
    """The rest pose that a character's bodies stand in."""
    parts: dict[tuple[Part, Side], tuple[str, ...]] = {}
    parents: dict[str, str] = {}
    hips = {}
    for body, joint in zip(character.bodies, character.joints, strict=True):
        parts[body.part, body.side] = (*parts.get((body.part, body.side), ()), body.bone)
        if joint.parent >= 0:
            parents[body.bone] = character.bodies[joint.parent].bone
        if body.part is Part.THIGH:
            hips[body.side] = joint.offset
    left = (hips[Side.LEFT] - hips[Side.RIGHT]) * np.array([1.0, 1.0, 0.0])
    tips = {body.bone: body.tip for body in character.bodies}
    along = {b: unit(tip) if np.linalg.norm(tip) > SHORTEST else UP for b, tip in tips.items()}
    return RestFigure(parts, parents, along, unit(left))


def _loaded(character: Character, body: int, limit: BendRange) -> BendRange:
    """An ankle's and a knee's range as it is under load."""
    match character.bodies[body].part:
        case Part.FOOT:
            more = radians(LOADED_DORSIFLEXION - ANKLE_FLEXION[1])
            return replace(limit, upper=limit.upper + more)
        case Part.SHANK:
            return replace(limit, lower=0.0)
    return limit


def _bend(
    character: Character, body: int, name: str, limit: BendRange, angles: FloatArray
) -> Iterator[JointRange]:
    """A bend's range, and, of a joint that can leave the plane of it, how far."""
    bend = bend_angle(character, body, angles)
    yield JointRange(f"{name} bends", body, bend, limit.lower, limit.upper)
    if bend.joint.axes.dofs == 3:
        most = radians(ASIDE[character.bodies[body].part])
        side = SideAngle(bend.joint, bend.along, np.cross(bend.straight, bend.flexion))
        yield JointRange(f"{name} leans aside", body, side, -most, most)


def _more(
    character: Character, figure: RestFigure, i: int, name: str, angles: FloatArray
) -> Iterator[JointRange]:
    """What the table of human_limits.py does not tell of a joint. name: that it has there."""
    body, dofs = character.bodies[i], character.joints[i].axes.dofs
    side = body.side.value.capitalize()
    along, count = figure.along[body.bone], len(figure.parts[body.part, body.side])
    match body.part:
        case Part.CLAVICLE:
            yield _clavicle(character, figure, i)
            backwards = _sense(along, figure.forward, UP)
            if dofs > 1:
                yield _twist(character, i, f"{side} collarbone", backwards, CLAVICLE_ROTATION)
        case Part.TOE:
            rest = bend_angle(character, i, angles).of(np.eye(3)[None])[0]
            low, high = (rest + radians(end) for end in TOE_FLEXION)
            limit = BendRange("", body.bone, low, high)
            yield from _bend(character, i, f"{side} toe", limit, angles)
        case Part.THIGH if dofs == 3:
            outwards = _sense(along, figure.forward, figure.outward(body.side))
            middle = unit(figure.forward - UP)  # amid its bends: half a turn is far
            zero = shortest_rotation(along, middle)
            yield _twist(character, i, name, outwards, HIP_ROTATION, zero)
        case Part.UPPER_ARM if dofs == 3:
            level = unit(figure.forward + figure.outward(body.side))
            medial = np.cross(np.cross(level, figure.forward), level)
            zero = _frame(level, medial) @ _frame(along, figure.forward).T
            upwards = _sense(level, medial, UP)
            yield _twist(character, i, name, upwards, SHOULDER_ROTATION, zero)
        case Part.FOREARM | Part.HAND if dofs > 1:
            yield _twist(character, i, name, 1.0, FOREARM_ROTATION)
        case Part.FOOT if dofs > 1:
            inwards = _sense(along, -UP, -figure.outward(body.side))
            yield _twist(character, i, name, inwards, FOOT_ROTATION)
        case Part.SPINE if dofs == 3:
            most = SPINE_ROTATION / count
            yield _twist(character, i, name, 1.0, (-most, most))
        case Part.NECK | Part.HEAD if dofs == 3:
            most = NECK_ROTATION / (1 + len(figure.parts.get((Part.NECK, Side.MIDDLE), ())))
            yield _twist(character, i, name, 1.0, (-most, most))


def _twist(
    character: Character,
    body: int,
    joint: str,
    sense: float,
    degrees: tuple[float, float],
    zero: FloatArray | None = None,
) -> JointRange:
    """Range of a joint's axial rotation, positive the way that `sense` says (1 or -1)."""
    zero = np.eye(3) if zero is None else zero
    low, high = sorted(sense * radians(end) for end in degrees)
    along = zero @ unit(character.bodies[body].tip)
    measure = TwistAngle(character.joints[body], along, zero=zero)
    return JointRange(f"{joint} turns", body, measure, low, high)


def _sense(axis: FloatArray, start: FloatArray, end: FloatArray) -> float:
    """1 where a positive turn about an axis takes `start` towards `end`, else -1."""
    return 1.0 if axis @ np.cross(start, end) > 0.0 else -1.0


def _frame(along: FloatArray, other: FloatArray) -> FloatArray:
    """(3, 3) columns: unit vectors along, across towards `other`, and at right angles to both."""
    across = other - along * (other @ along)
    across = unit(across if np.linalg.norm(across) > 1e-3 else np.cross(along, UP))
    return np.stack([along, across, np.cross(along, across)], axis=1)


def _clavicle(character: Character, figure: RestFigure, body: int) -> JointRange:
    """An elliptic cone about the middle of elevation and depression."""
    bone, side = character.bodies[body].bone, character.bodies[body].side
    along = figure.along[bone]
    low, high = CLAVICLE_ELEVATION
    up = unit(UP - along * along[2]) if abs(along[2]) < 0.95 else figure.forward
    raised = radians(0.5 * (low + high))
    axis = cos(raised) * along + sin(raised) * up
    ahead = unit(np.cross(up, axis))
    half, wide = radians(0.5 * (high - low)), radians(CLAVICLE_PROTRACTION)
    frame = np.stack([axis, ahead, np.cross(axis, ahead)])
    stretch = np.array([tan(wide) / tan(half), 1.0])
    cone = ConeAngle(character.joints[body], along, frame, stretch)
    return JointRange(f"{side.value.capitalize()} collarbone moves", body, cone, -inf, half)
