"""Recipes of a batch: a file, the ranges in it, and the recipe that it is with values in them."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping
from copy import deepcopy
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...bridge.recipe.objects import object_files
from ...bridge.recipe.problem import Recipe, read_recipe_text, recipe_of
from ...bridge.recipe.recording import FILE
from ...bridge.recipe_syntax.source_lines import KeyPath
from ...bridge.recipe_syntax.table import Source
from ...bridge.recipe_syntax.values import recipe_values
from ...solver.data.problem import MotionProblem
from ..records.faults import WrongPlan
from ..records.manifest import Value
from .ranges import HEADER, Combination, ValueRange, combination, count_of, find_ranges, variants

OWN_SKELETON = (
    '"asf" counts for single clips only; in a batch put the skeleton beside its AMC files'
)
OF_PLANNING = (HEADER, "clip")  # keys that say nothing of the motion


@dataclass(frozen=True)
class VariedRecipe:
    """A recipe's file as it is written, with the ranges that no value is given for.

    fixed: values that are given beforehand, by their places.
    """

    path: str
    values: dict[str, Any]
    source: Source
    ranges: tuple[ValueRange, ...]
    how: Combination
    fixed: Mapping[str, Value]

    @staticmethod
    def read(path: str, fixed: Mapping[str, Value] | None = None) -> VariedRecipe:
        """path: empty for none, which asks nothing. Raises BadRecipe; WrongPlan for a value whose
        place is not there."""
        fixed = fixed or {}
        if not path:
            return VariedRecipe("", {}, Source("", {}), (), Combination(), fixed)
        values, lines = recipe_values(read_recipe_text(path), path)
        source = Source(path, lines)
        given = {place_of(values, place, path) for place in fixed}
        ranges = tuple(r for r in find_ranges(values, source) if r.place not in given)
        return VariedRecipe(path, values, source, ranges, combination(values, source), fixed)

    @property
    def clip(self) -> str | None:
        """The clip that it names itself."""
        clip = self.values.get("clip")
        return str(Path(self.path).parent / clip) if isinstance(clip, str) else None

    @property
    def count(self) -> int:
        """How many variants it has. Raises BadRecipe."""
        return count_of(self.ranges, self.how, self.source)

    def variants(self) -> Iterator[dict[str, Value]]:
        """The values of each variant, by their places."""
        names = [name_of(self.values, each.place) for each in self.ranges]
        for chosen in variants(self.ranges, self.how):
            yield {**self.fixed, **dict(zip(names, chosen, strict=True))}

    def resolved(self, chosen: Mapping[str, Value]) -> dict[str, Any]:
        """The recipe's values with those chosen in their places. Raises WrongPlan."""
        made = deepcopy({k: v for k, v in self.values.items() if k not in OF_PLANNING})
        for name, value in chosen.items():
            *parents, last = place_of(made, name, self.path)
            node: Any = made
            for key in parents:
                node = node[key]
            node[last] = value
        return made

    def recipe(self, resolved: dict[str, Any]) -> Recipe:
        """What resolved values ask for. Raises BadRecipe."""
        recipe = recipe_of(resolved, self.source) if self.path else Recipe(MotionProblem())
        if recipe.file.asf is not None:
            self.source.refuse((FILE.header, "asf"), OWN_SKELETON)
        return recipe

    def sha256(self, resolved: dict[str, Any]) -> str:
        """Of resolved values and of the files that they name; comments and layout do not count."""
        content = hashlib.sha256(json.dumps(resolved, sort_keys=True, default=str).encode())
        for mesh in object_files(resolved, self.path):
            content.update(mesh.read_bytes())
        return content.hexdigest()

    @property
    def files(self) -> tuple[Path, ...]:
        """The recipe's file, and those that it names."""
        return (Path(self.path), *object_files(self.values, self.path)) if self.path else ()


def name_of(values: dict[str, Any], place: KeyPath) -> str:
    """A place in a recipe in words, such as "pin.Landing.forward"."""
    node: Any = values
    words = []
    for key in place:
        node = node[key]
        if isinstance(key, int):
            named = isinstance(node, dict) and isinstance(node.get("name"), str)
            words.append(node["name"] if named else str(key + 1))
        else:
            words.append(key)
    return ".".join(words)


def place_of(values: dict[str, Any], name: str, path: str) -> KeyPath:
    """The other way; the last key need not be there yet. Raises WrongPlan."""
    found = _place(values, name)
    if found is None:
        raise WrongPlan(
            f"Recipe {path} has no “{name}” for which a value is given; name a key of it, such as "
            "pin.Landing.forward."
        )
    return found


def _place(node: object, name: str) -> KeyPath | None:
    """Names may have dots in them, so every key that fits the beginning is tried."""
    keys: list[tuple[str | int, str]] = []
    if isinstance(node, dict):
        keys = [(key, key) for key in node]
    elif isinstance(node, list):
        named = ((i, each) for i, each in enumerate(node) if isinstance(each, dict))
        keys = [(i, str(each.get("name", i + 1))) for i, each in named]
    for key, word in keys:
        if name == word and isinstance(key, str):
            return (key,)
        if name.startswith(f"{word}."):
            inner = _place(node[key], name[len(word) + 1 :])  # type: ignore[index]
            if inner is not None:
                return (key, *inner)
    return (name,) if isinstance(node, dict) and name and "." not in name else None
