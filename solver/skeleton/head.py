"""The head from the skeleton's shape: the end of the midline above the shoulders.

Hair, wings, ties and armour hang on the midline or stand out from it, and lead elsewhere than to
where heads are. Places as of the skeletons of recordings, whose heads are 1.1 to 1.36 times as far
from the hips as the shoulders are, and whose necks 0.56 to 1.13 times.
"""

from collections.abc import Collection, Iterator
from dataclasses import dataclass

import numpy as np

from ..arrays import FloatArray
from .names import names_head
from .tree import Tree

OVER_TRUNK, OVER_LEG = 1.3, 0.65  # hips to head, over hips to shoulders and over hip to ankle
ONWARDS = 0.5  # cosine to the trunk of a step that still leads to the head


@dataclass(frozen=True)
class Trunk:
    """What a head is sought on. hub: the bone that the arms, which begin with `arms`, hang on.

    hips, shoulders: (3,) m, the middle between the joints. leg: m, from hip to ankle.
    """

    tree: Tree
    hub: int
    arms: Collection[int]
    hips: FloatArray
    shoulders: FloatArray
    leg: float

    def astray(self, bone: int) -> float:
        """m, from a bone's head to where it would be if it were the body's head."""
        place = self.hips + OVER_TRUNK * (self.shoulders - self.hips)
        return float(np.linalg.norm(self.tree.heads[bone] - place))

    def beyond(self, bone: int, before: int) -> bool:
        """Whether the bone before one is rather the head, by the lengths of trunk and leg."""
        off = [
            abs(float(np.linalg.norm(self.tree.heads[each] - self.hips)) - OVER_LEG * self.leg)
            for each in (bone, before)
        ]
        return self.astray(before) < self.astray(bone) and off[1] < off[0]

    def onwards(self, bone: int, following: int) -> bool:
        """Whether a step from bone to bone leads up the trunk."""
        step, along = self.tree.heads[following] - self.tree.heads[bone], self.shoulders - self.hips
        return bool(step @ along >= ONWARDS * np.linalg.norm(step) * np.linalg.norm(along))

    def lower(self, bone: int, other: int) -> bool:
        """Whether a bone's head is no higher up the trunk than another's."""
        off = self.tree.heads[bone] - self.tree.heads[other]
        return bool(off @ (self.shoulders - self.hips) <= 0.0)


def find_head(trunk: Trunk) -> int | None:
    """The head: a bone of the midline that is called so in any language, else where the midline
    branches, else its last bone but hair or a tip; None where nothing is above the arms."""
    middle = [bone for bone in trunk.tree.children[trunk.hub] if bone not in trunk.arms]
    if not middle:
        return None
    line = list(_line(trunk, _leading(trunk, middle)))
    for bone in line:
        if names_head(trunk.tree.name(bone)):
            return bone
    fans = len(trunk.tree.children[line[-1]]) > 1
    return line[-2] if len(line) > 1 and not fans and trunk.beyond(line[-1], line[-2]) else line[-1]


def _line(trunk: Trunk, bone: int) -> Iterator[int]:
    """The midline from a bone on, as far as it leads upwards and does not branch.

    A neck branches as well that a tie or a collar hangs on: what follows is nearer to a head.
    """
    tree = trunk.tree
    yield bone
    while tree.children[bone]:
        following = _leading(trunk, tree.children[bone])
        others = [each for each in tree.children[bone] if each != following]
        hang = all(trunk.lower(below, bone) for each in others for below in _below(tree, each))
        nearer = hang and trunk.astray(following) < trunk.astray(bone)
        if not trunk.onwards(bone, following) or (others and not nearer):
            return
        bone = following
        yield bone


def _leading(trunk: Trunk, bones: Collection[int]) -> int:
    """Of sibling bones the one that leads nearest to where heads are."""
    return min(bones, key=lambda bone: min(map(trunk.astray, _below(trunk.tree, bone))))


def _below(tree: Tree, bone: int) -> Iterator[int]:
    """A bone and all below it."""
    yield bone
    for child in tree.children[bone]:
        yield from _below(tree, child)
