"""The cells of a batch with what they left, read one after another."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from sys import intern

from ..records.manifest import BatchSettings, CellPlan, read_manifest
from ..records.result import CellResult, State, read_result

PICTURE = "sheet.png"  # in a cell's folder; the contact sheet in the batch's has the same name
Columns = dict[str, list[object]]


@dataclass(frozen=True)
class GatheredBatch:
    """The cells of a batch in the manifest's order; None where there is no result yet."""

    folder: Path
    settings: BatchSettings
    plans: tuple[CellPlan, ...]
    results: tuple[CellResult | None, ...]

    @property
    def states(self) -> list[State]:
        return [State.PLANNED if each is None else each.state for each in self.results]

    @cached_property
    def values(self) -> Columns:
        """What the recipes' ranges were, a column each."""
        return columns([plan.values for plan in self.plans])

    @cached_property
    def figures(self) -> Columns:
        """Numbers of the results by their names, a column each."""
        return columns([{} if each is None else each.figures for each in self.results])

    @cached_property
    def seconds(self) -> Columns:
        """Of "fit", "solve" and "total"."""
        return columns([{} if each is None else each.seconds for each in self.results])

    def files(self, i: int) -> tuple[str, ...]:
        """Names of the files in cell i's folder."""
        result = self.results[i]
        return () if result is None else result.files


def gather(folder: Path) -> GatheredBatch:
    """All that is told of a batch's cells. Raises WrongManifest, FolderGone."""
    manifest = read_manifest(folder)
    results = tuple(_slim(read_result(folder, plan.cell)) for plan in manifest.cells)
    return GatheredBatch(folder, manifest.settings, manifest.cells, results)


def _slim(result: CellResult | None) -> CellResult | None:
    """Without the values, which the plan tells too, and figures' names kept once for all cells."""
    if result is None:
        return None
    figures = {intern(name): value for name, value in result.figures.items()}
    return replace(result, values={}, figures=figures)


def columns(rows: Iterable[Mapping[str, object]]) -> Columns:
    """One list for each key that any row has, None where a row lacks it; keys as they come."""
    found: Columns = {}
    count = 0
    for row in rows:
        for key, value in row.items():
            column = found.setdefault(key, [])
            column.extend([None] * (count - len(column)))
            column.append(value)
        count += 1
    for column in found.values():
        column.extend([None] * (count - len(column)))
    return found


def short_keys(keys: Iterable[str]) -> dict[str, str]:
    """Each dotted key by as many of its last words as tell it from the others: "pin.Landing.up" is
    "up" where nothing else is."""
    distinct = [key.split(".") for key in dict.fromkeys(keys)]
    found = {}
    for words in distinct:
        enough = (
            n
            for n in range(1, len(words) + 1)
            if sum(other[-n:] == words[-n:] for other in distinct) == 1
        )
        found[".".join(words)] = ".".join(words[-next(enough, len(words)) :])
    return found
