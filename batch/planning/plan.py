"""Planning: clips, recipes and their ranges to the cells of a manifest."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import Any

from ...solver.data.faults import BadRecipe
from ..records.faults import FolderTaken, OtherVersion, WrongManifest, WrongPlan, gone
from ..records.manifest import (
    KEY_SHOWN,
    BatchSettings,
    CellPlan,
    Manifest,
    Value,
    read_manifest,
    write_manifest,
)
from ..records.names import short_names
from ..records.result import CELLS, State, read_result, spoilt_files
from .clips import clip_sha256
from .pairs import Pair, crossed, read_table
from .recipes import VariedRecipe

MOST_CELLS = 250_000


@dataclass(frozen=True)
class Asked:
    """What the command line asks for. clips, recipes: files, folders and patterns. table: instead
    of them."""

    settings: BatchSettings
    clips: Sequence[str] = ()
    recipes: Sequence[str] = ()
    table: Path | None = None


@dataclass(frozen=True)
class Planned:
    """A plan that was written. twice: pairs that are the same as another, and done once. strays:
    cells in the folder that are of an earlier plan and not of this one. spoilt: names of files that
    are missing or changed, by cells, which are to be solved again."""

    manifest: Manifest
    twice: int = 0
    strays: tuple[str, ...] = ()
    spoilt: Mapping[str, tuple[str, ...]] = field(default_factory=dict)


def plan(asked: Asked, folder: Path) -> Planned:
    """Writes the manifest of a batch into its folder; what is solved there already is kept.

    Raises BatchFault, BadRecipe; nothing was written then.
    """
    if asked.table is not None and (asked.clips or asked.recipes):
        raise WrongPlan("A table names clips and recipes itself; leave out the others, or --table.")
    check = asked.settings.check
    if asked.table is not None:
        pairs = read_table(asked.table, check=check)
    else:
        pairs = crossed(asked.clips, asked.recipes, folder, check=check)
    found = list(_cells(pairs))
    unique = {cell.key(asked.settings): cell for cell in found}
    _refuse_another(folder, found)
    cells, strays = _named(unique, folder)
    cells, spoilt = _as_left(folder, _told_apart(cells))
    manifest = Manifest(asked.settings, cells)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise gone(folder, error) from error
    write_manifest(folder, manifest)
    return Planned(manifest, len(found) - len(unique), strays, spoilt)


def _told_apart(cells: Sequence[CellPlan]) -> tuple[CellPlan, ...]:
    """The cells with names of clips and recipes that no two share."""
    clips = short_names(cell.clip for cell in cells)
    recipes = short_names(cell.recipe for cell in cells)
    return tuple(
        replace(cell, clip_name=clips[cell.clip], recipe_name=recipes[cell.recipe])
        for cell in cells
    )


def refreshed(folder: Path, cells: Sequence[CellPlan]) -> tuple[CellPlan, ...]:
    """The cells with the states that their results have."""
    results = ((cell, read_result(folder, cell.cell)) for cell in cells)
    return tuple(c if r is None else replace(c, state=r.state) for c, r in results)


def _as_left(
    folder: Path, cells: Sequence[CellPlan]
) -> tuple[tuple[CellPlan, ...], dict[str, tuple[str, ...]]]:
    """The cells with the states that their results have, but where files of a result are spoilt;
    and these files, by cells."""
    found, spoilt = [], {}
    for cell in cells:
        result = read_result(folder, cell.cell)
        if result is not None and result.state is not State.FAILED:
            spoilt[cell.cell] = spoilt_files(folder, cell.cell, result)
        stays = result is not None and not spoilt.get(cell.cell)
        found.append(replace(cell, state=result.state) if result and stays else cell)
    return tuple(found), {cell: files for cell, files in spoilt.items() if files}


# ---------------------------------------------------------------- the cells


@dataclass
class _Variants:
    """The variants of a recipe: values and hash of each, once for all clips."""

    made: list[tuple[dict[str, Value], str]] = field(default_factory=list)

    @staticmethod
    def of(recipe: VariedRecipe) -> _Variants:
        """Each is read once, so that what is wrong is told before anything is solved."""
        found = _Variants()
        for values in recipe.variants():
            resolved = recipe.resolved(values)
            _require_right(recipe, resolved)
            found.made.append((values, recipe.sha256(resolved)))
        return found


def _require_right(recipe: VariedRecipe, resolved: dict[str, Any]) -> None:
    """Raises BadRecipe; WrongPlan where it may be a table's value that is wrong, not the file."""
    try:
        recipe.recipe(resolved)
    except BadRecipe as fault:
        if not recipe.fixed:
            raise
        given = ", ".join(f"{name} = {value}" for name, value in recipe.fixed.items())
        raise WrongPlan(
            f"Recipe {recipe.path} with the table's {given}: {fault.problem}; correct the table, "
            "or the recipe."
        ) from fault


def _cells(pairs: Sequence[Pair]) -> Iterator[CellPlan]:
    hashed = cache(_clip_hash)
    read = cache(lambda path, values: VariedRecipe.read(path, dict(values)))
    varied = [read(pair.recipe, tuple(pair.values.items())) for pair in pairs]
    _refuse_many(sum(each.count for each in varied))
    made = cache(lambda path, values: _Variants.of(read(path, values)))
    for pair in pairs:
        for values, sha256 in made(pair.recipe, tuple(pair.values.items())).made:
            clip_hash = hashed(pair.clip)
            yield CellPlan("", pair.clip, clip_hash, pair.recipe, sha256, values)


def _clip_hash(path: str) -> str:
    try:
        return clip_sha256(path)
    except OSError as error:
        raise WrongPlan(f"{path} cannot be read ({error.strerror}); check it.") from error


def _refuse_many(count: int) -> None:
    if count > MOST_CELLS:
        raise WrongPlan(
            f"That would be {count:,} cells, and a batch holds at most {MOST_CELLS:,}; give fewer "
            'clips or steps, draw samples (combine = "sample"), or make several batches.'
        )


def _refuse_another(folder: Path, cells: Sequence[CellPlan]) -> None:
    """A folder is one batch's: some clip of what was planned before must be asked for again, be it
    changed, or moved with the library."""
    if not folder.exists():
        return
    try:
        before = read_manifest(folder).cells
    except OtherVersion:
        raise
    except WrongManifest:
        return  # it is written anew
    if before and not _paths_and_hashes(before) & _paths_and_hashes(cells):
        clips = len({cell.clip for cell in before})
        raise FolderTaken(
            f"{folder} holds another batch, with {clips} other clips; take another folder."
        )


def _paths_and_hashes(cells: Sequence[CellPlan]) -> set[str]:
    return {word for cell in cells for word in (cell.clip, cell.clip_sha256)}


def _named(
    unique: dict[str, CellPlan], folder: Path
) -> tuple[tuple[CellPlan, ...], tuple[str, ...]]:
    """The cells by key under the names of their folders, where these are there, or under new ones;
    and the names of the folders that are none of theirs."""
    try:
        there = {p.name for p in (folder / CELLS).iterdir() if not p.name.startswith(".")}
    except FileNotFoundError:
        there = set()
    except OSError as error:
        raise gone(folder, error) from error
    by_key = {name.rpartition("-")[2]: name for name in there}
    taken = {name.partition("-")[0] for name in there}
    numbers = (n for n in range(1, MOST_CELLS * 2) if f"{n:05}" not in taken)
    cells = []
    for key, cell in unique.items():
        shown = key[:KEY_SHOWN]
        name = by_key.get(shown) or f"{next(numbers):05}-{shown}"
        cells.append(replace(cell, cell=name))
    return tuple(cells), tuple(sorted(there - {cell.cell for cell in cells}))
