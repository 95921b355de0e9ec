"""Parts of the body from the skeleton's shape alone: whatever its bones are called.

Lengths as shares of a stature by Drillis and Contini (1966): thigh .245, shank .246, upper arm
.186, forearm .146; foot .152 long and .039 high, of which the ball is at some .72, the ankle at
.25. Rest poses of all kinds are taken: T, A, and bent.
"""

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from ..arrays import FloatArray
from .head import Trunk, find_head
from .limb_pairs import LimbPair, find_limbs, without_props
from .names import side_of
from .parts import LEG, SIDES, Found, Part, Side
from .tree import Tree

SHANK_OVER_THIGH = 0.246 / 0.245
FOREARM_OVER_UPPER_ARM = 0.146 / 0.186
BALL = np.hypot(0.152 * (0.72 - 0.25), 0.039) / 0.491  # ankle to ball, over hip to ankle
APART = 1.15  # shoulders over hips, at least; what is nearer to its twin is a clavicle
SEEN = 0.02  # of the trunk's length: knees or toes that lead ahead by less do not tell where it is
NEAR = 1e-3  # of a limb's length: bones nearer to each other have one joint
LONGER, TURNED, FANNED = 0.2, 0.5, 0.5  # weights of a limb's other marks against its proportions


def by_shape(tree: Tree) -> Found:
    """The bones of legs, arms and head; empty where the skeleton has no two pairs of limbs.

    Hands, toes, clavicles may lack; so may all of it, for what is no humanoid. What one hand alone
    holds has bones as well, and does not count.
    """
    return _by_limbs(tree) or _by_limbs(without_props(tree))


def _by_limbs(tree: Tree) -> Found:
    """As `by_shape`, of limbs that mirror each other as they are."""
    limbs = find_limbs(tree)
    if limbs is None:
        return {}
    legs = [_leg(tree, line) for line in _twin_lines(tree, limbs.legs)]
    if not all(legs):
        return {}
    hips = _gap(tree, [leg[Part.THIGH] for leg in legs])
    arms = [_arm(tree, limbs.arms, k, hips) for k in range(2)]
    head = _head(tree, limbs.arms, legs, arms) if all(arms) else None
    if head is None:
        return {}
    left = _left(tree, legs, head)
    found: Found = {(Part.HEAD, Side.MIDDLE): head}
    for limb in (legs, arms):
        for side, mine in zip(SIDES, _ordered(tree, limb, left), strict=True):
            found |= {(part, side): bone for part, bone in mine.items()}
    return found


def _leg(tree: Tree, line: Sequence[int]) -> dict[Part, int]:
    """Thigh, shank, foot and toe in the line of one leg; empty where it has no three joints."""
    line = _distinct(tree, line)
    split = _best_split(tree, line, SHANK_OVER_THIGH)
    if split is None:
        return {}
    hip, knee, ankle = split
    leg = {Part.THIGH: line[hip], Part.SHANK: line[knee], Part.FOOT: line[ankle]}
    beyond = line[ankle + 1 :]
    if beyond:
        points = tree.heads[line]
        wanted = BALL * _length(points[hip : ankle + 1])
        from_ankle = np.linalg.norm(tree.heads[beyond] - points[ankle], axis=1)
        leg[Part.TOE] = beyond[int(np.argmin(np.abs(from_ankle - wanted)))]
    return leg


def _twin_lines(tree: Tree, pair: LimbPair) -> list[list[int]]:
    """The lines of both limbs, without what one alone has on the head of its last bone, such as a
    claw on a toe."""
    lines = [tree.main_line(first) for first in pair.first]
    shared = min(map(len, lines))
    for line in lines:
        near = NEAR * _length(tree.heads[line])
        while len(line) > shared and _gap(tree, line[-2:]) <= near:
            line.pop()
    return lines


def _arm(tree: Tree, arms: LimbPair, k: int, hips: float) -> dict[Part, int]:
    """Clavicle, upper arm, forearm and hand of one arm; empty where it has no two joints.

    hips: m, from one hip to the other.
    """
    lines = [_distinct(tree, tree.main_line(first)) for first in arms.first]
    line, twin = lines[k], lines[1 - k]
    shared = min(len(line), len(twin))
    wide = [i for i in range(shared) if _gap(tree, (line[i], twin[i])) >= APART * hips]
    shoulder = min(wide[0] if wide else 0, len(line) - 2)
    below = line[shoulder:]
    split = _best_split(tree, below, FOREARM_OVER_UPPER_ARM, start=0)
    arm = {Part.CLAVICLE: line[shoulder - 1]} if shoulder > 0 else {}
    if split is None:
        return arm | {Part.UPPER_ARM: below[0], Part.FOREARM: below[1]}
    _, elbow, wrist = split
    return arm | {
        Part.UPPER_ARM: below[0],
        Part.FOREARM: below[elbow],
        Part.HAND: below[wrist],
    }


def _best_split(
    tree: Tree, line: Sequence[int], ratio: float, start: int | None = None
) -> tuple[int, int, int] | None:
    """Places in a line of bones at which its upper bone, its lower bone and its end begin.

    ratio: of the lower to the upper one's length. start: where the upper one begins, if known.
    Bones between, as twist bones are, and beyond do not matter: of all splits the one is best whose
    lengths are in proportion, that is long, and at whose end the limb turns or fans out. So a bone
    that leads aside to the hip is no thigh either.
    """
    points = tree.heads[list(line)]
    best: tuple[float, tuple[int, int, int]] | None = None
    for first, middle, end in combinations(range(len(line)), 3):
        if start is not None and first != start:
            continue
        upper, lower = _length(points[first : middle + 1]), _length(points[middle : end + 1])
        cost = abs(np.log(lower / upper / ratio)) - LONGER * np.log(upper + lower)
        if end + 1 < len(line):
            on = points[end + 1] - points[end]
            cost -= TURNED * (1.0 - _cosine(points[end] - points[middle], on))
        cost -= FANNED * _fans(tree, line[end])
        if best is None or cost < best[0]:
            best = float(cost), (first, middle, end)
    return best[1] if best is not None else None


def _fans(tree: Tree, bone: int) -> bool:
    """Whether several fingers or the like go on from a bone: two joints each, in unlike directions.

    Twist bones have one joint and lie on their bone.
    """
    lines = [tree.heads[b] - tree.heads[bone] for b in tree.children[bone] if tree.children[b]]
    return any(_cosine(a, b) < np.cos(np.radians(5.0)) for a, b in combinations(lines, 2))


def _head(
    tree: Tree, limbs: LimbPair, legs: Sequence[dict[Part, int]], arms: Sequence[dict[Part, int]]
) -> int | None:
    """The head, above the middle between hips and shoulders."""
    hips = np.mean([tree.heads[leg[Part.THIGH]] for leg in legs], axis=0)
    shoulders = np.mean([tree.heads[arm[Part.UPPER_ARM]] for arm in arms], axis=0)
    length = np.mean([_length(tree.heads[[leg[p] for p in LEG[:3]]]) for leg in legs])
    return find_head(Trunk(tree, limbs.hub, limbs.first, hips, shoulders, float(length)))


def _ordered(
    tree: Tree, limbs: Sequence[dict[Part, int]], left: FloatArray
) -> Sequence[dict[Part, int]]:
    """The left limb, then the right one: as their names say in any language, else by place.

    left: (3,) towards the body's left.
    """
    for bones in zip(*(limb.values() for limb in limbs), strict=False):
        told = [side_of(tree.name(bone)) for bone in bones]
        if set(told) == set(SIDES):
            return limbs if told[0] is Side.LEFT else limbs[::-1]
    outer = [tree.heads[list(limb.values())[-1]] for limb in limbs]
    return limbs if (outer[0] - outer[1]) @ left >= 0.0 else limbs[::-1]


def _left(tree: Tree, legs: Sequence[dict[Part, int]], head: int) -> FloatArray:
    """(3,) towards the body's left, by where toes point, or knees where there are none.

    Blender's +X where neither tells.
    """
    hips, knees, ankles = (
        np.mean([tree.heads[leg[part]] for leg in legs], axis=0)
        for part in (Part.THIGH, Part.SHANK, Part.FOOT)
    )
    up = tree.heads[head] - hips
    toes = [
        tree.heads[leg[Part.TOE]] - tree.heads[leg[Part.FOOT]] for leg in legs if Part.TOE in leg
    ]
    for ahead in (np.sum(toes, axis=0) if toes else np.zeros(3), knees - 0.5 * (hips + ankles)):
        left = np.cross(up, ahead)
        if np.linalg.norm(left) > SEEN * float(up @ up):
            return left
    return np.array([1.0, 0.0, 0.0])


def _distinct(tree: Tree, line: Sequence[int]) -> list[int]:
    """The bones of a line without those that sit on the next one's head."""
    near = NEAR * _length(tree.heads[list(line)])
    return [
        bone
        for bone, after in zip(line, [*line[1:], None], strict=True)
        if after is None or np.linalg.norm(tree.heads[after] - tree.heads[bone]) > near
    ]


def _gap(tree: Tree, pair: Sequence[int]) -> float:
    """m, between two bones' heads."""
    return float(np.linalg.norm(tree.heads[pair[0]] - tree.heads[pair[1]]))


def _length(points: FloatArray) -> float:
    """m, along points (N, 3)."""
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def _cosine(a: FloatArray, b: FloatArray) -> float:
    """Of the angle between two vectors (3,)."""
    return float(a @ b / max(float(np.linalg.norm(a) * np.linalg.norm(b)), 1e-12))
