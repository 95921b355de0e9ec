"""The two pairs of limbs of a skeleton, found without names: subtrees that mirror each other."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import combinations, pairwise, permutations

import numpy as np

from .tree import Tree

UNEQUAL = 0.2  # sum of the relative differences up to which two subtrees mirror each other
ODD = 0.1  # what a joint more on one side adds to that
SHORTEST = 0.4  # of the longest pair: what reaches less far is no limb, but fingers, eyes, a skirt
SAME = 0.1  # of a limb's reach: joints of twins are as far from each other to within that
# Clavicle to wrist over hip to ball, of shares of a stature by Drillis and Contini (1966), and
# .1 for a clavicle; fingers and tips of toes reach about as much farther.
ARM_OVER_LEG = (0.1 + 0.186 + 0.146) / (0.491 + 0.08)
FEWEST_JOINTS = 3  # of an arm without clavicle or of a leg without toes


@dataclass(frozen=True)
class LimbPair:
    """Two mirrored limbs on one bone: their first bones, and the hub that they hang on, -1 for two
    roots."""

    hub: int
    first: tuple[int, int]


@dataclass(frozen=True)
class Limbs:
    """The two legs and the two arms."""

    legs: LimbPair
    arms: LimbPair


def find_limbs(tree: Tree) -> Limbs | None:
    """Legs and arms; None where the skeleton has not two such pairs on different bones.

    Legs hang nearer to the root than arms. Of several pairs on one bone, legs reach farthest, and
    arms branch most, as hands do and wings do not, or else are nearest to an arm's length.
    """
    pairs = list(_outermost(tree))
    longest = max((_reach(tree, pair) for pair in pairs), default=0.0)
    pairs = [pair for pair in pairs if _reach(tree, pair) >= SHORTEST * longest > 0.0]
    if not pairs:
        return None
    legs = min(pairs, key=lambda pair: (_depth(tree, pair), -_reach(tree, pair)))
    others = [p for p in pairs if p.hub != legs.hub]
    if not others:
        return None
    length = ARM_OVER_LEG * _reach(tree, legs)

    def unlike_arms(pair: LimbPair) -> tuple[int, int, float]:
        return (
            _depth(tree, pair),
            -_size(tree, pair.first[0]),
            abs(float(np.log(_reach(tree, pair) / length))),
        )

    arms = min(others, key=unlike_arms)
    return Limbs(legs, arms)


def without_props(tree: Tree) -> Tree:
    """The tree without what only one of two limbs holds: bones beyond the end of the other one,
    where joint by joint the two are alike."""
    odd: set[int] = set()
    roots = [bone for bone in tree.inside if tree.parents[bone] < 0]
    for siblings in (roots, *(tree.children[bone] for bone in tree.inside)):
        for a, b in permutations(siblings, 2):
            if tree.reach[b] > tree.reach[a] > 0.0:
                odd.update(_beyond(tree, tree.main_line(a), b))
    held = {bone for bone in tree.inside if odd & set(tree.ancestors(bone))}
    return replace(tree, inside=tuple(bone for bone in tree.inside if bone not in held))


def _beyond(tree: Tree, line: list[int], first: int) -> Iterator[int]:
    """First bones of what reaches beyond a line of a limb on its twin, which begins with `first`;
    none where the line has no twin there."""
    if len(line) < FEWEST_JOINTS:
        return
    twin, room = [first], SAME * tree.reach[line[0]]
    for above, below in pairwise(line):
        step = _step(tree, above, below)
        near = [b for b in tree.children[twin[-1]] if abs(_step(tree, twin[-1], b) - step) <= room]
        if not near:
            return
        twin.append(max(near, key=lambda bone: float(tree.reach[bone])))
    for mine, theirs in zip(line, twin, strict=True):
        for bone in tree.children[theirs]:
            if _step(tree, theirs, bone) + tree.reach[bone] > tree.reach[mine] + room:
                yield from () if bone in twin else (bone,)


def _step(tree: Tree, above: int, below: int) -> float:
    """m, from a bone's head to that of one below it."""
    return float(np.linalg.norm(tree.heads[below] - tree.heads[above]))


def _outermost(tree: Tree) -> Iterator[LimbPair]:
    """Pairs of mirrored subtrees that are in no other such pair, from the roots down."""
    roots = [bone for bone in tree.inside if tree.parents[bone] < 0]
    open_hubs: list[tuple[int, list[int]]] = [(-1, roots)]
    while open_hubs:
        hub, bones = open_hubs.pop()
        paired: set[int] = set()
        for pair in _mirrored(tree, hub, bones):
            paired.update(pair.first)
            yield pair
        for bone in bones:
            if bone not in paired:
                open_hubs.append((bone, list(tree.children[bone])))


def _mirrored(tree: Tree, hub: int, bones: list[int]) -> Iterator[LimbPair]:
    """The best matches among a bone's children, each child in one pair at most."""
    joints = {b: len(tree.main_line(b)) for b in bones if tree.reach[b] > 0.0}
    limbs = [b for b in joints if joints[b] >= FEWEST_JOINTS]
    ranked = sorted(
        (mismatch, a, b)
        for a, b in combinations(limbs, 2)
        if (mismatch := _mismatch(tree, hub, a, b) + ODD * abs(joints[a] - joints[b])) < UNEQUAL
    )
    taken: set[int] = set()
    for _, a, b in ranked:
        if not {a, b} & taken:
            taken |= {a, b}
            yield LimbPair(hub, (a, b))


def _mismatch(tree: Tree, hub: int, a: int, b: int) -> float:
    """How differently two subtrees reach, and branch off their hub; lengths alone, so that any rest
    pose will do."""
    reach = max(tree.reach[a], tree.reach[b])
    off = [0.0 if hub < 0 else np.linalg.norm(tree.heads[x] - tree.heads[hub]) for x in (a, b)]
    return float((abs(tree.reach[a] - tree.reach[b]) + abs(off[0] - off[1])) / reach)


def _reach(tree: Tree, pair: LimbPair) -> float:
    return float(min(tree.reach[bone] for bone in pair.first))


def _depth(tree: Tree, pair: LimbPair) -> int:
    return tree.depth(pair.hub) if pair.hub >= 0 else -1


def _size(tree: Tree, bone: int) -> int:
    """Number of bones in a subtree."""
    return 1 + sum(_size(tree, child) for child in tree.children[bone])
