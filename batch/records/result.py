"""Results of cells: a folder each, which is there whole or not at all."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field
from enum import Enum
from errno import ESTALE
from pathlib import Path

from .aside import removed, written_aside
from .faults import gone
from .locks import held

CELLS, FITS = "cells", "fits"  # within a batch's folder
RESULT = "result.json"  # within a cell's; its last file to be written
WORSE = "certificate_worse_than_recorded"  # figure: lines that fail, and not as in the recording
LOOKS = 3  # at a result that another machine replaces meanwhile
PLACING = ".placing.lock"  # within a batch's; held while a cell takes its place


class State(Enum):
    """How a cell stands, as manifest and results tell it."""

    PLANNED = "planned"
    DONE = "done"
    NO_SOLUTION = "no solution"
    WRONG_INPUT = "wrong input"
    FAILED = "failed"  # by no fault of what was asked: a crash, too little memory, a lost clip

    @property
    def exit_code(self) -> int:
        """That of `adapt`. A cell that is planned has none."""
        return {State.DONE: 0, State.FAILED: 1, State.WRONG_INPUT: 2, State.NO_SOLUTION: 3}[self]


@dataclass(frozen=True)
class CellResult:
    """The end of a cell.

    sentence: why it is not done, for people; empty where it is. headline: of the report. seconds:
    of "fit", "solve", "report" and "total". figures: numbers by names with their units. values:
    what the recipe's ranges were for it. clip, recipe: as the manifest names them. files: what lies
    in the folder beside result.json; sizes: theirs, bytes, which older results do not tell.
    """

    cell: str
    state: State
    clip: str
    recipe: str
    version: str
    sentence: str = ""
    headline: tuple[str, ...] = ()
    seconds: Mapping[str, float] = field(default_factory=dict)
    figures: Mapping[str, float] = field(default_factory=dict)
    values: Mapping[str, object] = field(default_factory=dict)
    files: tuple[str, ...] = ()
    sizes: Mapping[str, int] = field(default_factory=dict)

    @property
    def exit_code(self) -> int:
        return self.state.exit_code

    def as_json(self) -> str:
        """The text of result.json."""
        content = {**asdict(self), "state": self.state.value, "exit_code": self.exit_code}
        return json.dumps(content, ensure_ascii=False, allow_nan=False, indent=1) + "\n"

    @staticmethod
    def parsed(text: str) -> CellResult:
        """The other way. Raises ValueError where the text is none of ours."""
        try:
            content = json.loads(text)
            del content["exit_code"]
            content["state"] = State(content["state"])
            for name in ("headline", "files"):
                content[name] = tuple(content[name])
            return CellResult(**content)
        except (KeyError, TypeError, AttributeError) as error:
            raise ValueError("not the result of a cell") from error


def cell_folder(folder: Path, cell: str) -> Path:
    """The folder of a cell in a batch's folder."""
    return folder / CELLS / cell


def read_result(folder: Path, cell: str) -> CellResult | None:
    """The result of a cell in a batch's folder, None where there is none that is whole. Raises
    FolderGone where nobody can tell."""
    path = cell_folder(folder, cell) / RESULT
    for looks_left in reversed(range(LOOKS)):
        try:
            return CellResult.parsed(path.read_text(encoding="utf-8"))
        except (FileNotFoundError, NotADirectoryError, ValueError):
            return None
        except OSError as error:
            # On a network: another machine has just put a new folder in the place of this one.
            if error.errno != ESTALE or not looks_left:
                raise gone(path, error) from error
    return None


def lasting_result(folder: Path, cell: str) -> CellResult | None:
    """The result of a cell that is not solved again: any but a failure, or one whose files are not
    as they were written. Raises FolderGone."""
    found = read_result(folder, cell)
    if found is None or found.state is State.FAILED or spoilt_files(folder, cell, found):
        return None
    return found


def spoilt_files(folder: Path, cell: str, result: CellResult) -> tuple[str, ...]:
    """A result's files that are missing, or empty or of another size than they were written. Raises
    FolderGone."""
    path = cell_folder(folder, cell)
    try:
        with os.scandir(path) as entries:
            found = {entry.name: entry.stat().st_size for entry in entries}
    except FileNotFoundError:  # one that goes meanwhile
        return result.files
    except OSError as error:
        raise gone(path, error) from error
    whole = {name for name, size in found.items() if size == result.sizes.get(name, size or None)}
    return tuple(name for name in result.files if name not in whole)


@contextmanager
def written_cell(folder: Path, cell: str) -> Iterator[Path]:
    """A folder to write a cell into, which takes the cell's place at the end: that of a failure, or
    of a folder without a result. A lasting result stays, and this one is dropped.

    Two that solve the same cell may end at once, on two machines: one after the other then looks
    and takes the place, so that neither removes what the other has just put there. Raises
    FolderGone.
    """
    try:
        with written_aside(cell_folder(folder, cell), _turn(folder, cell)) as aside:
            yield aside
    except OSError as error:
        raise gone(folder, error) from error


@contextmanager
def _turn(folder: Path, cell: str) -> Iterator[None]:
    with held(folder / PLACING):
        if lasting_result(folder, cell) is None:
            removed(cell_folder(folder, cell))
        yield
