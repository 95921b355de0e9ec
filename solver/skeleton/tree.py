"""The skeleton as a tree, within one family of bones where a rig has several."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import FloatArray
from ..data.recording import Bone

FAMILIES = ("DEF-", "ORG-")  # Rigify's deform bones and, where there are none, what they follow
FEWEST = 10  # bones that make a family


@dataclass(frozen=True)
class Tree:
    """Bones by index, with the parents that they have in their family.

    parents: (B,) indices, -1 for a root. inside: the bones that may be parts of the body.
    prefix: of the family's names; "" where there is none.
    """

    bones: tuple[Bone, ...]
    parents: tuple[int, ...]
    inside: tuple[int, ...]
    prefix: str = ""

    @cached_property
    def children(self) -> tuple[tuple[int, ...], ...]:
        """Of each bone, those inside."""
        below: list[list[int]] = [[] for _ in self.bones]
        for bone in self.inside:
            if self.parents[bone] >= 0:
                below[self.parents[bone]].append(bone)
        return tuple(map(tuple, below))

    @cached_property
    def heads(self) -> FloatArray:
        """(B, 3) rest positions, m."""
        return np.stack([bone.head for bone in self.bones])

    @cached_property
    def reach(self) -> FloatArray:
        """(B,) m, from a bone's head along the bones to the farthest head below it."""
        reach = np.zeros(len(self.bones))
        for bone in sorted(self.inside, key=self.depth, reverse=True):
            above = self.parents[bone]
            if above >= 0:
                step = float(np.linalg.norm(self.heads[bone] - self.heads[above]))
                reach[above] = max(reach[above], step + reach[bone])
        return reach

    def name(self, bone: int) -> str:
        """A bone's name without its family's prefix."""
        return self.bones[bone].name.removeprefix(self.prefix)

    def ancestors(self, bone: int) -> list[int]:
        """The bone and its ancestors, nearest first."""
        line = []
        while bone >= 0:
            line.append(bone)
            bone = self.parents[bone]
        return line

    def depth(self, bone: int) -> int:
        """Number of ancestors."""
        return len(self.ancestors(bone)) - 1

    def main_line(self, bone: int) -> list[int]:
        """The bone and those below it, always on to the child that reaches farthest."""
        line = [bone]
        while self.children[line[-1]]:
            here = self.heads[line[-1]]
            line.append(
                max(
                    self.children[line[-1]],
                    key=lambda child: float(
                        np.linalg.norm(self.heads[child] - here) + self.reach[child]
                    ),
                )
            )
        return line


def tree_of(bones: Sequence[Bone]) -> Tree:
    """The tree of the bones, parents first; of one family's alone where names tell families.

    A bone whose parent is of another family hangs on the bone that stands for this parent in its
    own: Rigify's DEF-thigh.L, below ORG-spine, on DEF-spine.
    """
    names = [bone.name for bone in bones]
    for prefix in FAMILIES:
        inside = tuple(i for i, name in enumerate(names) if name.startswith(prefix))
        if len(inside) >= FEWEST:
            index = {names[i].removeprefix(prefix): i for i in inside}
            parents = [_above(bones, i, index) for i in range(len(bones))]
            return Tree(tuple(bones), tuple(parents), inside, prefix)
    return Tree(tuple(bones), tuple(bone.parent for bone in bones), tuple(range(len(bones))))


def _above(bones: Sequence[Bone], bone: int, index: dict[str, int]) -> int:
    """The nearest ancestor in a family, or what stands for it there; -1 where there is none.

    index: the family's bones by their names without prefix.
    """
    above = bones[bone].parent
    while above >= 0:
        name = bones[above].name
        bare = next((name.removeprefix(p) for p in FAMILIES if name.startswith(p)), name)
        if index.get(bare, bone) != bone:
            return index[bare]
        above = bones[above].parent
    return -1
