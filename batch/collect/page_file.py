"""index.html: one page with everything in it but pictures, films and reports, which it links to."""

from __future__ import annotations

import html
import json
import math
import re
from collections.abc import Iterable, Mapping, Sequence
from datetime import datetime
from pathlib import Path
from typing import Any

from ..records.manifest import Output
from ..records.names import short_names
from ..records.result import State
from .files import file_aside
from .gathering import PICTURE, Columns, GatheredBatch, short_keys

PARTS = Path(__file__).with_name("page")
SCRIPTS = ("data.js", "filters.js", "lists.js", "plot.js", "cell.js", "main.js")
DIGITS = 6  # of figures on the page; table.csv has them in full


def write_page(batch: GatheredBatch, path: Path) -> None:
    """Raises FolderGone."""
    parts = {
        "title": html.escape(batch.folder.resolve().name),
        "style": (PARTS / "page.css").read_text(encoding="utf-8"),
        "data": as_embedded(page_data(batch)),
        "script": "".join((PARTS / name).read_text(encoding="utf-8") for name in SCRIPTS),
    }
    template = (PARTS / "page.html").read_text(encoding="utf-8")
    with file_aside(path) as aside, aside.open("w", encoding="utf-8", newline="\n") as file:
        for k, piece in enumerate(re.split(r"\{\{(\w+)\}\}", template)):
            file.write(parts[piece] if k % 2 else piece)


def as_embedded(data: object) -> str:
    """JSON that cannot end the element of the page that it stands in, whatever it says."""
    text = json.dumps(data, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c")


def page_data(batch: GatheredBatch) -> dict[str, Any]:
    """The batch by columns, each text once; see page/data.js."""
    clip_names = short_names(plan.clip for plan in batch.plans)
    recipe_names = short_names(plan.recipe for plan in batch.plans)
    clips, clip = _numbered(clip_names[plan.clip] for plan in batch.plans)
    recipes, recipe = _numbered(recipe_names[plan.recipe] for plan in batch.plans)
    states, state = _numbered(each.value for each in batch.states)
    results = batch.results
    sentences, sentence = _numbered("" if r is None else r.sentence for r in results)
    file_sets, files = _numbered(batch.files(i) for i in range(len(results)))
    return {
        "collected": datetime.now().strftime("%Y-%m-%d %H:%M"),
        "version": batch.settings.version,
        "notes": list(notes(batch)),
        "picture": PICTURE,
        "cells": [plan.cell for plan in batch.plans],
        "clips": clips,
        "clip": clip,
        "recipes": recipes,
        "recipe": recipe,
        "states": states,
        "state": state,
        "sentences": sentences,
        "sentence": sentence,
        "headlines": [() if r is None else r.headline for r in results],
        "file_sets": file_sets,
        "files": files,
        "seconds": [_shown(x) for x in batch.seconds.get("total", [None] * len(results))],
        "values": _table(batch.values, short_keys(batch.values)),
        "figures": _table(batch.figures),
    }


def notes(batch: GatheredBatch) -> Iterable[str]:
    """Sentences about the whole batch."""
    waiting = batch.states.count(State.PLANNED)
    if batch.settings.check:
        yield "Clips were only checked and fitted."
    if waiting:
        yield f"{waiting} of {len(batch.plans)} are not run yet; give the same command again."
    if Output.PICTURE not in batch.settings.outputs:
        yield "No pictures were asked for (--outputs picture)."
    same = [(name, column[0]) for name, column in batch.values.items() if len(set(column)) == 1]
    if same and len(batch.plans) > 1:
        yield f"The same in all cells: {', '.join(f'{name} {value}' for name, value in same)}."


def _numbered(entries: Iterable[Any]) -> tuple[list[Any], list[int]]:
    """The distinct entries, and for each entry which of them it is."""
    known: dict[Any, int] = {}
    numbers = [known.setdefault(entry, len(known)) for entry in entries]
    return list(known), numbers


def _table(columns: Columns, short: Mapping[str, str] = {}) -> list[dict[str, Any]]:
    return [
        {"name": name, "short": short.get(name, name), "column": [_shown(x) for x in column]}
        for name, column in columns.items()
    ]


def _shown(x: object) -> object:
    """A number with the digits that the page has; None where it is not finite."""
    if isinstance(x, float):
        return float(f"{x:.{DIGITS}g}") if math.isfinite(x) else None
    if x is None or isinstance(x, int | str):
        return str(x).lower() if isinstance(x, bool) else x
    return ", ".join(map(str, x)) if isinstance(x, Sequence) else str(x)
