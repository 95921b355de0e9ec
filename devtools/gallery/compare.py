"""Compares the trajectories of two folders of results: python3 dev.py compare BEFORE AFTER.

For every trajectory.npz below BEFORE the one of the same path below AFTER must hold the same
arrays. Ends with 1 where one differs or is missing, or where there is nothing to compare.
"""

import argparse
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...bridge.formats.paths import no_folder

FILE = "trajectory.npz"
NUMBERS = "fiub"  # kinds of numpy's types
Array = NDArray[Any]


@dataclass(frozen=True)
class Comparison:
    """Of one result. largest: the largest difference of any number, in the unit of its array;
    array: the one that has it. fault: why there is nothing to measure, or None."""

    name: str
    largest: float = 0.0
    array: str = ""
    fault: str | None = None

    def same(self, within: float) -> bool:
        return self.fault is None and self.largest <= within

    def line(self, within: float) -> str:
        found = self.fault or f"{self.largest:.3g} in {self.array}"
        return f"{self.name:28}{'same' if self.same(within) else 'DIFFERS':9}{found}"


def main(argv: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="dev.py compare", description=__doc__)
    parser.add_argument("before", type=Path, metavar="BEFORE")
    parser.add_argument("after", type=Path, metavar="AFTER")
    words = "the most that a number may differ, in the unit of its array (default: 1e-6)"
    parser.add_argument("--within", type=float, default=1e-6, metavar="X", help=words)
    options = parser.parse_args(argv)
    for folder in (options.before, options.after):
        if problem := no_folder(folder):
            parser.error(f"{folder} cannot be read ({problem}); name a folder of results")
    found = []
    for comparison in compare_folders(options.before, options.after):
        print(comparison.line(options.within), flush=True)
        found.append(comparison.same(options.within))
    print(f"{sum(found)} of {len(found)} results below {options.before} are the same")
    return 0 if found and all(found) else 1


def compare_folders(before: Path, after: Path) -> Iterator[Comparison]:
    """Every result below `before` with the one of the same path below `after`."""
    for path in sorted(before.rglob(FILE)):
        relative = path.relative_to(before)
        name = relative.parent.as_posix()
        try:
            yield compare(name, load(path), load(after / relative))
        except FileNotFoundError:
            yield Comparison(name, fault="is missing")
        except (OSError, ValueError, EOFError, zipfile.BadZipFile) as problem:
            yield Comparison(name, fault=f"cannot be read: {problem}")


def load(path: Path) -> dict[str, Array]:
    """The file's arrays. Raises OSError; ValueError, EOFError, BadZipFile where it is none."""
    with path.open("rb") as file, np.load(file, allow_pickle=False) as archive:
        return {name: archive[name] for name in archive.files}


def compare(name: str, before: dict[str, Array], after: dict[str, Array]) -> Comparison:
    """The arrays of one result by their names."""
    alone = sorted(before.keys() ^ after.keys())
    if alone:
        return Comparison(name, fault=f"{alone[0]} is in one of them only")
    apart = {}
    for array, values in before.items():
        found = difference(values, after[array])
        if isinstance(found, str):
            return Comparison(name, fault=f"{array}: {found}")
        apart[array] = found
    if not apart:
        return Comparison(name, fault="holds no arrays")
    worst = max(apart, key=apart.__getitem__)
    return Comparison(name, apart[worst], worst)


def difference(before: Array, after: Array) -> float | str:
    """The largest of all numbers, 0 for the same words; in words, why there is none. What is not a
    number is like itself alone."""
    if before.shape != after.shape:
        return f"shape {before.shape}, then {after.shape}"
    kinds = [array.dtype.kind in NUMBERS for array in (before, after)]
    if not all(kinds):
        return "other words" if any(kinds) or not np.array_equal(before, after) else 0.0
    a, b = before.astype(float), after.astype(float)
    with np.errstate(invalid="ignore"):
        apart = np.where((a == b) | (np.isnan(a) & np.isnan(b)), 0.0, np.abs(a - b))
    return float(np.where(np.isnan(apart), np.inf, apart).max(initial=0.0))
