"""Conventions by which programs name bones: a table each, in the folder `tables`.

A table has the convention's `name`, what its `sides` are called in names ([left, right], several
where versions differ), `prefixes` that names may begin with (regular expressions), and under
`[bones]` what the bone of each part may be called, {side} standing for the side. `marks` are bones
that this convention has and its look-alikes lack.
"""

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, lru_cache
from pathlib import Path

from .names import plain
from .parts import REQUIRED_KEYS, SIDED_PARTS, SIDES, Found, Key, Part, Side
from .tree import Tree

TABLES = Path(__file__).parent / "tables"
FULL = len(REQUIRED_KEYS)


@lru_cache(maxsize=10_000)  # a skeleton is mapped again and again, by each convention
def _bare(prefix: re.Pattern[str], name: str) -> str:
    return plain(prefix.sub("", re.split(r"[:|]", name)[-1]) or name)


@dataclass(frozen=True)
class Convention:
    """Names of bones: by part and side, in order of preference, as `plain` makes them."""

    name: str
    prefix: re.Pattern[str]
    bones: Mapping[Key, tuple[str, ...]]
    marks: frozenset[str]

    def bare(self, name: str) -> str:
        """A bone's name without namespace and prefix, as `plain` makes it."""
        return _bare(self.prefix, name)

    def match(self, tree: Tree) -> tuple[Found, int]:
        """The bones that go by this convention's names, and how many of its marks are there."""
        index: dict[str, int] = {}
        for i in tree.inside:
            index.setdefault(self.bare(tree.name(i)), i)
        found: Found = {}
        for key, names in self.bones.items():
            bone = next((index[name] for name in names if name in index), None)
            if bone is not None and bone not in found.values():
                found[key] = bone
        prefixed = any(self.prefix.match(tree.name(i)) for i in tree.inside)
        return found, len(self.marks & index.keys()) + prefixed


@dataclass(frozen=True)
class Matched:
    """What a convention's names tell. name: the convention's."""

    name: str
    bones: Found


@cache
def conventions() -> tuple[Convention, ...]:
    """All that there are tables of."""
    return tuple(map(_read, sorted(TABLES.glob("*.toml"))))


def matched(tree: Tree) -> Matched | None:
    """The convention that names most parts, among equals the one with the most marks.

    None where none names every part that the physics needs.
    """
    best: tuple[tuple[int, int], Matched] | None = None
    for convention in conventions():
        found, marks = convention.match(tree)
        if all(key in found for key in REQUIRED_KEYS) and (
            best is None or (len(found), marks) > best[0]
        ):
            best = (len(found), marks), Matched(convention.name, found)
    return best[1] if best is not None else None


def _read(path: Path) -> Convention:
    table = tomllib.loads(path.read_text(encoding="utf-8"))
    bones: dict[Key, tuple[str, ...]] = {}
    for word, names in table["bones"].items():
        part = Part(word)
        if part in SIDED_PARTS:
            for k, side in enumerate(SIDES):
                bones[part, side] = tuple(
                    plain(name.format(side=pair[k])) for name in names for pair in table["sides"]
                )
        else:
            bones[part, Side.MIDDLE] = tuple(map(plain, names))
    prefix = re.compile("|".join(f"^(?:{p})" for p in table.get("prefixes", [])) or r"(?!)")
    return Convention(table["name"], prefix, bones, frozenset(map(plain, table.get("marks", []))))
