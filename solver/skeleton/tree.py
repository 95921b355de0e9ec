"""The skeleton as a tree, within one family of bones where a rig has several."""

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import FloatArray
from ..data.recording import Bone
from .inner_bones import inner_parents

FAMILIES = ("DEF-", "ORG-")  # Rigify's deform bones, and the bones that these follow
SEGMENT = re.compile(r"\.\d+$")
FEWEST = 10  # bones that make a family
COPY = re.compile(r"\.\d{3}$")  # what Blender puts behind the names of a copy's bones
COPIED = 0.8  # share of the bones that have the same behind them in a copy


@dataclass(frozen=True)
class Tree:
    """Bones by index, with the parents that they have in their family.

    parents: (B,) indices, -1 for a root. inside: the bones that may be parts of the body.
    prefixes: of the family's names; none where there is no family.
    """

    bones: tuple[Bone, ...]
    parents: tuple[int, ...]
    inside: tuple[int, ...]
    prefixes: tuple[str, ...] = ()

    @property
    def family(self) -> bool:
        """Whether the body's bones are but some of the rig's."""
        return len(self.inside) < len(self.bones)

    @property
    def generated(self) -> bool:
        """Whether the bones that a generator's deform bones follow are there, and its controls."""
        return any(bone.name.startswith(FAMILIES[1]) for bone in self.bones)

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

    @property
    def in_order(self) -> bool:
        """Whether parents come first, as in the armature."""
        return not self.family and all(above < bone for bone, above in enumerate(self.parents))

    @cached_property
    def suffix(self) -> str:
        """What stands behind all names in a copy of a rig, but for the few that it makes others;
        "" where nothing does."""
        ends = (COPY.search(self.bones[bone].name) for bone in self.inside)
        counts = Counter(end[0] for end in ends if end is not None)
        suffix, count = max(counts.items(), key=lambda item: item[1], default=("", 0))
        return suffix if count >= COPIED * len(self.inside) else ""

    def name(self, bone: int) -> str:
        """A bone's name without its family's prefix, and without what a copy has behind it."""
        name = self.bones[bone].name.removesuffix(self.suffix)
        return bare(name) if self.prefixes else name

    def ancestors(self, bone: int) -> list[int]:
        """The bone and its ancestors, nearest first."""
        return _line(self.parents, bone)

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


def bare(name: str) -> str:
    """A name without a family's prefix."""
    return next((name.removeprefix(p) for p in FAMILIES if name.startswith(p)), name)


def tree_of(bones: Sequence[Bone]) -> Tree:
    """The tree of the bones, parents first; of a control rig's family alone where there is one.

    Of Auto-Rig Pro's rig its inner bones. Of a generated rig:
    Deform bones, but for a limb that has several in a row, which share out its twist: of these the
    one that they follow. A bone whose parent is of another family hangs on the bone that stands for
    this parent in its own: Rigify's ORG-thigh.L, below ORG-spine, on DEF-spine. A bone of none,
    such as a control that was chosen, keeps its parent where nothing above it is of the family.
    Bones that lie flat, each following another, hang together as those do.
    """
    names = [bone.name for bone in bones]
    inner = inner_parents(names)
    if inner:
        return _tree_within(bones, inner)
    index: dict[str, int] = {}
    for prefix in FAMILIES:
        family = {bare(n): i for i, n in enumerate(names) if n.startswith(prefix)}
        index = {**family, **index}
    real = [bone.parent for bone in bones]
    if len(index) < FEWEST:
        everything = range(len(bones))
        return Tree(tuple(bones), tuple(_led(bones, real, everything)), tuple(everything))
    followed = {bare(n): i for i, n in enumerate(names) if n.startswith(FAMILIES[1])}
    for name in tuple(index):
        whole = SEGMENT.sub("", name)
        if followed and name not in followed and whole in followed:
            index[whole] = followed[whole]
            del index[name]
    inside = sorted(index.values())
    parents = [_above(bones, i, index) for i in range(len(bones))]
    parents = [real[i] if p < 0 and i not in inside else p for i, p in enumerate(parents)]
    return Tree(tuple(bones), tuple(_led(bones, parents, inside)), tuple(inside), FAMILIES)


def _tree_within(bones: Sequence[Bone], inner: Mapping[str, str | None]) -> Tree:
    """The tree of some bones, by name, whose parents are told."""
    index = {bone.name: i for i, bone in enumerate(bones)}
    parents = [-1] * len(bones)
    for name, above in inner.items():
        parents[index[name]] = -1 if above is None else index[above]
    return Tree(tuple(bones), tuple(parents), tuple(sorted(index[name] for name in inner)))


def _above(bones: Sequence[Bone], bone: int, index: dict[str, int]) -> int:
    """The nearest ancestor in a family, or what stands for it there; -1 where there is none.

    index: the family's bones by their names without prefix.
    """
    above = bones[bone].parent
    while above >= 0:
        name = bare(bones[above].name)
        if index.get(name, bone) != bone:
            return index[name]
        above = bones[above].parent
    return -1


def _led(bones: Sequence[Bone], parents: Sequence[int], inside: Sequence[int]) -> list[int]:
    """The parents, but of bones that lie flat those of the bones that they follow.

    Flat are those on one root, or that are all roots themselves, if they are as many as a family.
    A flat bone hangs on the one that follows the nearest control above its own, or on this control
    where that may be part of the body.
    """
    names = {bone.name: i for i, bone in enumerate(bones)}
    leaders = {i: names[bones[i].follows] for i in inside if bones[i].follows in names}
    roots = {-1, *(i for i, above in enumerate(parents) if above < 0)}
    beneath = Counter(parents[i] for i in leaders if parents[i] in roots)
    flat = [i for i in leaders if beneath[parents[i]] >= FEWEST]
    followers = {leaders[i]: i for i in reversed(flat)}
    found = list(parents)
    for bone in flat:
        line = _line([each.parent for each in bones], leaders[bone])[1:]
        hooks = (followers.get(control, control) for control in line)
        may = (i for i in hooks if i in inside and bone not in _line(found, i))
        found[bone] = next(may, found[bone])
    return found


def _line(parents: Sequence[int], bone: int) -> list[int]:
    """A bone and its ancestors, nearest first."""
    line = []
    while bone >= 0:
        line.append(bone)
        bone = parents[bone]
    return line
