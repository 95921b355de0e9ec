"""Ranges of cells as the engines of farms write them: "1-10,12,20-30:2"."""

import re
from collections.abc import Iterable
from itertools import groupby
from pathlib import Path

from ..records.faults import WrongManifest, WrongPlan
from ..records.manifest import MANIFEST, read_manifest

PART = re.compile(r"\s*(\d+)\s*(?:-\s*(\d+)\s*(?::\s*(\d+)\s*)?)?")


def numbers_of(text: str, most: int) -> list[int]:
    """The numbers from 1 to `most` that a range names, in order, each once. Raises WrongPlan."""
    numbers: set[int] = set()
    for part in text.split(","):
        match = PART.fullmatch(part)
        if match is None:
            raise WrongPlan(f"“{text}” is no range of cells; write one such as 1-10,12.")
        first, last, step = match.groups()
        begin, end = int(first), int(last or first)
        if not 1 <= begin <= end <= most or step == "0":
            raise WrongPlan(
                f"“{part.strip()}” is no range of the cells 1 to {most}; mend “{text}”."
            )
        numbers |= set(range(begin, end + 1, int(step or 1)))
    return sorted(numbers)


def range_text(numbers: Iterable[int]) -> str:
    """The other way: "1-3,7". numbers: rising."""
    runs = groupby(enumerate(numbers), key=lambda pair: pair[1] - pair[0])
    parts = [[number for _, number in run] for _, run in runs]
    return ",".join(f"{part[0]}-{part[-1]}" if part[1:] else f"{part[0]}" for part in parts)


def cells_in(folder: Path, text: str) -> list[str]:
    """Names of a batch's cells that a range names by their places in the manifest.

    Raises WrongPlan, WrongManifest, FolderGone.
    """
    names = [plan.cell for plan in read_manifest(folder).cells]
    if not names:
        raise WrongManifest(f"{folder / MANIFEST} has no cells; plan a batch into that folder.")
    return [names[number - 1] for number in numbers_of(text, len(names))]
