"""The body's solid shapes: capsules about its bones, and which of them may meet.

A capsule has the girth of its segment: that of the skinned mesh (flesh.py), or else the segment's
mass (mass_tables.py), its length and the body's density give its cross-section. Flesh gives, so
only a share of the radius is solid.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray, IntArray
from ..body.anatomy import Part, Side
from ..body.character import Body, Character
from ..body.kinematics import BodyPoint, Pose
from ..numerics.rotations import unit
from .flesh import Flesh
from .segments import closest_shares
from .shape_changes import AS_IS, ShapeChanges

SOLID_SHARE = 0.8  # of a segment's radius; what is further out is flesh, which gives
LIMBS = (
    Part.UPPER_ARM,
    Part.FOREARM,
    Part.HAND,
    Part.THIGH,
    Part.SHANK,
    Part.FOOT,
    Part.TOE,
)
FEET = (Part.FOOT, Part.TOE)
WIDE = 0.1  # of its radius, by which a body must be wider to be two capsules side by side


@dataclass(frozen=True)
class Capsule:
    """Points at most `radius` m from the segment start to end, (3,) m each, in a body's frame."""

    body: int
    start: FloatArray
    end: FloatArray
    radius: float


@dataclass(frozen=True)
class Capsules:
    """C capsules as arrays: bodies (C,), start, end (C, 3) m, radius (C,) m."""

    bodies: IntArray
    start: FloatArray
    end: FloatArray
    radius: FloatArray

    @staticmethod
    def of(capsules: Sequence[Capsule]) -> "Capsules":
        """The same as arrays."""
        return Capsules(
            np.array([c.body for c in capsules], dtype=int),
            np.array([c.start for c in capsules]).reshape(-1, 3),
            np.array([c.end for c in capsules]).reshape(-1, 3),
            np.array([c.radius for c in capsules]),
        )

    def ends(self, pose: Pose) -> tuple[FloatArray, FloatArray]:
        """Both ends of each segment, (N, C, 3) m, from the centre of mass."""
        turns, centres = pose.rotations[:, self.bodies], pose.centres[:, self.bodies]
        start, end = (
            centres + np.einsum("ncij,cj->nci", turns, local) for local in (self.start, self.end)
        )
        return start, end

    def some_ends(
        self, pose: Pose, instants: IntArray, items: IntArray
    ) -> tuple[FloatArray, FloatArray]:
        """Both ends (M, 3) m of some capsules (M,) at instants (M,), from the centre of mass."""
        at = instants, self.bodies[items]
        turns, centres = pose.rotations[at], pose.centres[at]
        start, end = (
            centres + np.einsum("mij,mj->mi", turns, local[items])
            for local in (self.start, self.end)
        )
        return start, end


def capsules(character: Character, changes: ShapeChanges = AS_IS) -> list[Capsule]:
    """Each body's capsule from its joint to its tip; two side by side where it is wide."""
    parents = {joint.parent for joint in character.joints}
    return [
        capsule
        for i, body in enumerate(character.bodies)
        for capsule in _of_body(i, body, changes, leaf=i not in parents)
    ]


def _of_body(index: int, body: Body, changes: ShapeChanges, *, leaf: bool) -> list[Capsule]:
    flesh = changes.flesh.get(index)
    if flesh is None:
        return _of_bone(index, body, changes.factor(index), leaf=leaf)
    return _of_mesh(index, body, flesh, changes.factor(index), leaf=leaf)


def _of_mesh(
    index: int, body: Body, flesh: Flesh, thickness: float, *, leaf: bool
) -> list[Capsule]:
    radius, aside = SOLID_SHARE * thickness * flesh.radius, SOLID_SHARE * thickness * flesh.aside
    start, end = flesh.centre, flesh.centre + _shortened(flesh.reach * body.tip, radius, leaf=leaf)
    sides = (aside, -aside) if aside.any() else (aside,)
    return [Capsule(index, start + side, end + side, radius) for side in sides]


def _of_bone(index: int, body: Body, thickness: float, *, leaf: bool) -> list[Capsule]:
    narrow, wide = thickness * np.sort(body.box_size[:2])
    radius = float(SOLID_SHARE * narrow / np.sqrt(np.pi))  # of the circle of a square's area
    start, end = np.zeros(3), _shortened(body.tip, radius, leaf=leaf)
    apart = SOLID_SHARE * 0.5 * (wide - narrow)
    if apart < WIDE * radius:
        return [Capsule(index, start, end, radius)]
    aside = apart * body.box_rotation[:, int(np.argmax(body.box_size[:2]))]
    return [Capsule(index, start + side, end + side, radius) for side in (aside, -aside)]


def _shortened(tip: FloatArray, radius: float, *, leaf: bool) -> FloatArray:
    """(3,) where a capsule's axis ends: a hand ends at its tip, not a radius beyond."""
    length = float(np.linalg.norm(tip))
    return tip - unit(tip) * min(radius, 0.5 * length) if leaf and length > 0.0 else tip


def floor_balls(
    character: Character, points: Sequence[BodyPoint], changes: ShapeChanges = AS_IS
) -> list[Capsule]:
    """What must stay above the floor: the capsules' far ends, and of the feet their soles.

    points: the body points that touch; where a sole is, they say (a standing foot is not in the
    floor). A ball of radius 0 is a point. The ball of a foot is as thick as it is above the line
    from heel to toe.
    """
    balls = [
        Capsule(c.body, c.end, c.end, c.radius)
        for c in capsules(character, changes)
        if character.bodies[c.body].part not in FEET
    ]
    for i, body in enumerate(character.bodies):
        if body.part in FEET:
            soles = [p.place for p in points if p.body == i]
            balls += [Capsule(i, place, place, 0.0) for place in soles]
            balls.append(Capsule(i, body.tip, body.tip, _thickness(character, points, i)))
    return [ball for ball in balls if ball.body not in changes.loose]


def _thickness(character: Character, points: Sequence[BodyPoint], foot: int) -> float:
    """Distance, m, of a foot's ball from the line through heel and toe in the rest pose; 0 of toes,
    and where one of the two never touches."""
    toes = [i for i, joint in enumerate(character.joints) if joint.parent == foot]
    heel = [p.place for p in points if p.body == foot]
    toe = [character.joints[p.body].offset + p.place for p in points if p.body in toes]
    if not heel or not toe:
        return 0.0
    sole, ball = unit(toe[0] - heel[0]), character.bodies[foot].tip - heel[0]
    return float(np.linalg.norm(ball - sole * (sole @ ball)))


def meeting_pairs(
    character: Character, shapes: Sequence[Capsule], changes: ShapeChanges = AS_IS
) -> IntArray:
    """(P, 2) indices of the capsules that may meet, and must not.

    One of the two is of a limb. Neighbours at a joint, and next but one along a limb, are in each
    other's way by the joint's own range; pairs that are in each other at rest belong together.
    """
    pairs = [
        (i, j)
        for i, one in enumerate(shapes)
        for j, other in enumerate(shapes[:i])
        if may_meet(character, one.body, other.body) and not changes.may_pass(one.body, other.body)
    ]
    at = np.array(pairs, dtype=int).reshape(-1, 2)
    apart = _rest_distance(character, Capsules.of(shapes), at)
    return np.asarray(at[apart > 0.0])


def may_meet(character: Character, i: int, j: int) -> bool:
    """True where one is of a limb, and joints enough lie between them, or both sides' limbs."""
    one, other = character.bodies[i], character.bodies[j]
    if one.part not in LIMBS and other.part not in LIMBS:
        return False
    across = {one.side, other.side} == {Side.LEFT, Side.RIGHT}
    return across or len(set(character.ancestors(i)) ^ set(character.ancestors(j))) > 2


def _rest_distance(character: Character, shapes: Capsules, pairs: IntArray) -> FloatArray:
    """(P,) m between the capsules of pairs in the rest pose."""
    centres = np.zeros((1, len(character.bodies), 3))
    for i, joint in enumerate(character.joints):
        if joint.parent >= 0:
            centres[:, i] = centres[:, joint.parent] + joint.offset
    turns = np.tile(np.eye(3), (1, len(character.bodies), 1, 1))
    start, end = (each[0] for each in shapes.ends(Pose(character, turns, centres, np.empty(0))))
    first, second = pairs.T
    s, t = closest_shares(
        start[first], end[first] - start[first], start[second], end[second] - start[second]
    )
    gap = start[first] + s[:, None] * (end - start)[first]
    gap -= start[second] + t[:, None] * (end - start)[second]
    return np.asarray(np.linalg.norm(gap, axis=1) - shapes.radius[pairs].sum(axis=1))
