"""Which clip goes with which recipe: every one with every other, or as a table names them.

A table is a CSV file with the columns clip and recipe, and one for each value that a row has of its
own, headed by its place in the recipe, such as pin.Landing.forward; or a TOML file:

[[pair]]
clip = "hop.bvh"                # relative to the table, like the recipe
recipe = "further.toml"
"pin.Landing.forward" = 0.2
"""

from __future__ import annotations

import csv
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from io import StringIO
from pathlib import Path
from typing import Any

from ..records.faults import WrongPlan
from ..records.manifest import Value
from .clips import absolute, files_meant, find_clips, is_file
from .recipes import VariedRecipe

RECIPES = (".toml", ".json")
PAIR = "pair"


@dataclass(frozen=True)
class Pair:
    """A clip with a recipe, and values that are given for it. recipe: empty for none."""

    clip: str
    recipe: str
    values: Mapping[str, Value] = field(default_factory=dict)


def crossed(clips: Sequence[str], recipes: Sequence[str], out: Path, *, check: bool) -> list[Pair]:
    """Every clip with every recipe; where no clip is given, each recipe with its own.

    out: the batch's folder, in which none of them lies. check: no recipe is needed. Raises
    WrongPlan, BadRecipe.
    """
    found = find_recipes(recipes, out)
    if not found and not check:
        raise WrongPlan("No recipe is given; add --recipes FILES, or --check to only diagnose.")
    if not clips:
        return [Pair(_own_clip(recipe, out), recipe) for recipe in found]
    every = find_clips(clips, out)
    return [Pair(clip, recipe) for clip in every for recipe in found or [""]]


def _own_clip(recipe: str, out: Path) -> str:
    clip = VariedRecipe.read(recipe).clip
    if clip is None:
        raise WrongPlan(f'No clip is given, and {recipe} names none; add it, or clip = "…" there.')
    return find_clips([clip], out)[0]


def find_recipes(words: Sequence[str], out: Path) -> list[str]:
    """The recipes that files, folders and patterns mean. out: as in `find_clips`. Raises
    WrongPlan."""
    found: dict[str, None] = {}
    for word in words:
        path = Path(word)
        paths = [path] if is_file(path) else files_meant(word, RECIPES, out)
        if not paths:
            raise WrongPlan(f"No recipe (.toml, .json) is meant by “{word}”; check the path.")
        found.update(dict.fromkeys(map(absolute, paths)))
    return list(found)


def read_table(path: Path, *, check: bool) -> list[Pair]:
    """The pairs of a table. Raises WrongPlan with the line or row of what is wrong."""
    try:
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise WrongPlan(f"Table {path} is no text; save it as UTF-8.") from error
    except OSError as error:
        raise WrongPlan(f"Table {path} cannot be read ({error.strerror}); check it.") from error
    rows = _toml_rows(text, path) if path.suffix.lower() == ".toml" else _csv_rows(text, path)
    pairs = [_pair(place, row, path, check) for place, row in rows]
    if not pairs:
        raise WrongPlan(f"Table {path} has no rows; write a clip and a recipe in each.")
    return pairs


def _pair(place: str, row: dict[str, Any], table: Path, check: bool) -> Pair:
    def file(key: str) -> str:
        word = row.pop(key, "")
        if not isinstance(word, str) or not (word.strip() or (check and key == "recipe")):
            raise WrongPlan(f"Table {table}, {place} has no {key}; add it.")
        if not word.strip():
            return ""
        found = table.parent / word.strip()
        if not is_file(found):
            raise WrongPlan(f"Table {table}, {place}: there is no {key} {found}; check its path.")
        return absolute(found)

    pair = Pair(file("clip"), file("recipe"), row)
    for name, value in pair.values.items():
        if not isinstance(value, bool | int | float | str):
            raise WrongPlan(f"Table {table}, {place}: “{name}” must be one number or word.")
    return pair


def _toml_rows(text: str, path: Path) -> Iterator[tuple[str, dict[str, Any]]]:
    try:
        content = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise WrongPlan(f"Table {path} is not TOML ({error}); correct the line.") from error
    rows = content.get(PAIR, [])
    if set(content) - {PAIR} or not isinstance(rows, list):
        raise WrongPlan(f"Table {path} must hold [[{PAIR}]] tables, and nothing else.")
    for number, row in enumerate(rows, start=1):
        yield f"{PAIR} {number}", dict(row)


def _csv_rows(text: str, path: Path) -> Iterator[tuple[str, dict[str, Any]]]:
    reader = csv.DictReader(StringIO(text, newline=""))
    head = [name.strip() for name in reader.fieldnames or ()]
    if "clip" not in head or len(set(head)) < len(head):
        raise WrongPlan(
            f"Table {path} must begin with a line of column names, each once and with commas "
            "between: “clip”, “recipe” and places in the recipe."
        )
    reader.fieldnames = head
    for row in _read(reader, path):
        if None in row or None in row.values():
            problem = f"line {reader.line_num} has another number of columns than line 1"
            raise WrongPlan(f"Table {path}: {problem}; correct it.")
        files = {key: row.pop(key) for key in ("clip", "recipe") if key in row}
        given = {key: _value(text) for key, text in row.items() if text.strip()}
        yield f"line {reader.line_num}", {**files, **given}


def _read(reader: csv.DictReader[str], path: Path) -> Iterator[dict[str | Any, str | Any]]:
    try:
        yield from reader
    except csv.Error as error:
        problem = f"line {reader.line_num + 1} cannot be read ({error})"
        raise WrongPlan(f"Table {path}: {problem}; correct it.") from error


def _value(text: str) -> Value:
    """A number, true or false where it reads as one; else a word."""
    for convert in (int, float):
        with suppress(ValueError):
            return convert(text)
    return {"true": True, "false": False}.get(text.strip(), text.strip())
