"""table.csv: a line a cell, for spreadsheets and scripts."""

from __future__ import annotations

import csv
from pathlib import Path

from ..records.names import short_names
from .files import file_aside
from .gathering import GatheredBatch

LEADING = ("cell", "clip", "recipe", "state", "exit_code", "sentence")


def write_table(batch: GatheredBatch, path: Path) -> None:
    """Clips and recipes by the names that the page has; numbers in full, empty where a cell has
    none. UTF-8 with a mark that spreadsheets need to read names in other letters. Raises
    FolderGone."""
    clips = short_names(plan.clip for plan in batch.plans)
    recipes = short_names(plan.recipe for plan in batch.plans)
    seconds = {f"{name}_s": column for name, column in batch.seconds.items()}
    more = [*batch.values.items(), *seconds.items(), *batch.figures.items()]
    with file_aside(path) as aside, aside.open("w", encoding="utf-8-sig", newline="") as file:
        writer = csv.writer(file)
        writer.writerow([*LEADING, *(name for name, _ in more)])
        cells = zip(batch.plans, batch.states, batch.results, strict=True)
        for i, (plan, state, result) in enumerate(cells):
            code, why = ("", "") if result is None else (result.exit_code, result.sentence)
            names = plan.cell, clips[plan.clip], recipes[plan.recipe]
            leading = (*names, state.value, code, why)
            writer.writerow([*leading, *(column[i] for _, column in more)])
