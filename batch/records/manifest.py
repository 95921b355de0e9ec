"""The manifest of a batch: manifest.jsonl, a line for the batch, then a line a cell."""

from __future__ import annotations

import hashlib
import json
import os
import tomllib
from collections import Counter
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass, field, replace
from enum import Enum
from functools import cache
from pathlib import Path
from typing import Any, Literal

from .faults import OtherVersion, WrongManifest, gone
from .result import State

MANIFEST = "manifest.jsonl"
FORMAT = 1
SUM = "sum"  # of a line: a digest of all else in it, by which it knows an edit
_LATER = ("armature", "take")  # settings that the first manifests did not have
KEY_SHOWN = 16  # hexadecimal digits of a cell's key in its name; two of 250,000 never share them
Value = float | int | str | bool
AGAIN = "give the batch's command again, which writes it anew and keeps what is solved"


class Output(Enum):
    """What a cell leaves beside log and report; the values are the command line's words."""

    NPZ = "npz"
    BVH = "bvh"
    PICTURE = "picture"
    FBX = "fbx"
    GLTF = "gltf"
    BLEND = "blend"
    FILM = "film"

    @property
    def needs_blender(self) -> bool:
        return self not in (Output.NPZ, Output.BVH)


@cache
def version() -> str:
    """Hangtime's own."""
    file = Path(__file__).parents[2] / "blender_manifest.toml"
    return str(tomllib.loads(file.read_text(encoding="utf-8"))["version"])


@dataclass(frozen=True)
class BatchSettings:
    """What all cells of a batch share. check: only diagnose and fit.

    unit: m per unit of the clips, up: their axis that points up, rate: Hz, of AMC and BVH
    files, armature and take: of FBX files; None where the files tell, or it is guessed.
    """

    outputs: tuple[Output, ...] = (Output.NPZ,)
    check: bool = False
    unit: float | None = None
    up: Literal["Y", "Z"] | None = None
    rate: float | None = None
    armature: str | None = None
    take: str | None = None
    version: str = field(default_factory=version)

    def as_record(self) -> dict[str, Any]:
        record = {"format": FORMAT, **asdict(self), "outputs": [o.value for o in self.outputs]}
        for name in _LATER:
            if record[name] is None:  # cells go by this: those of batches before it stay the same
                del record[name]
        return record

    @staticmethod
    def of_record(record: dict[str, Any]) -> BatchSettings:
        """Raises ValueError, KeyError or TypeError where it is none."""
        if record.pop("format") != FORMAT:
            raise ValueError("another format")
        outputs = tuple(Output(word) for word in record.pop("outputs"))
        return BatchSettings(outputs=outputs, **record)


@dataclass(frozen=True)
class CellPlan:
    """One clip with one recipe, or what its ranges make of it.

    cell: its name and its folder's. clip, recipe: paths; recipe is empty where a clip is only
    checked. recipe_sha256: of what the recipe says with the values in it, and of the files that it
    names. values: by places in the recipe, such as "pin.Landing.forward". state: when the manifest
    was written. clip_name, recipe_name: as the page has them, by which no two of a batch are the
    same; older manifests have none.
    """

    cell: str
    clip: str
    clip_sha256: str
    recipe: str
    recipe_sha256: str
    values: Mapping[str, Value] = field(default_factory=dict)
    state: State = State.PLANNED
    clip_name: str = ""
    recipe_name: str = ""

    @property
    def number(self) -> str:
        """The part of its name that people read."""
        return self.cell.partition("-")[0]

    @property
    def names(self) -> tuple[str, str]:
        """Of clip and recipe, for people."""
        return self.clip_name or Path(self.clip).name, self.recipe_name or Path(self.recipe).name

    def key(self, settings: BatchSettings) -> str:
        """SHA-256, hexadecimal, of all that the cell's result depends on: names and contents, but
        not the folders that these lie in."""
        shared = {k: v for k, v in settings.as_record().items() if k != "format"}
        names = Path(self.clip).name, Path(self.recipe).name
        content = [*names, self.clip_sha256, self.recipe_sha256, shared]
        return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()

    def named(self, number: int, settings: BatchSettings) -> CellPlan:
        """The same under the name that the number and its key make."""
        return replace(self, cell=f"{number:05}-{self.key(settings)[:KEY_SHOWN]}")


@dataclass(frozen=True)
class Manifest:
    """A batch and its cells, in their order."""

    settings: BatchSettings
    cells: tuple[CellPlan, ...]


def read_manifest(folder: Path) -> Manifest:
    """The manifest of a batch's folder. Raises WrongManifest with the line, FolderGone."""
    first, *lines = _text(folder).removesuffix("\n").split("\n")
    cells = tuple(_cell(folder, number, line) for number, line in enumerate(lines, start=2))
    manifest = Manifest(_settings(folder, first), cells)
    _require_true(folder, manifest)
    return manifest


def read_plan(folder: Path, cell: str) -> tuple[BatchSettings, CellPlan]:
    """One cell's line alone, as quick as that can be. Raises as `read_manifest`."""
    text = _text(folder)
    first = text.partition("\n")[0]
    start = text.find(f'\n{{"cell": {json.dumps(cell)}')
    if start < 0:
        path = folder / MANIFEST
        raise WrongManifest(f"{path} has no cell “{cell}”; check its name, or {AGAIN}.")
    number = text.count("\n", 0, start) + 2
    line = text[start + 1 :].partition("\n")[0]
    manifest = Manifest(_settings(folder, first), (_cell(folder, number, line),))
    _require_true(folder, manifest)
    return manifest.settings, manifest.cells[0]


def write_manifest(folder: Path, manifest: Manifest) -> None:
    """Writes it aside, and gives it its name once it is whole; into a folder that is there, for one
    that is gone may come back. Raises FolderGone."""
    records = [manifest.settings.as_record()]
    records += [{**asdict(cell), "state": cell.state.value} for cell in manifest.cells]
    summed = ({**record, SUM: _sum(record)} for record in records)
    text = "".join(f"{json.dumps(record, ensure_ascii=False)}\n" for record in summed)
    aside = folder / f".{MANIFEST}.{os.getpid()}"
    try:
        aside.write_text(text, encoding="utf-8")
        os.replace(aside, folder / MANIFEST)
    except OSError as error:
        with suppress(OSError):
            aside.unlink(missing_ok=True)
        raise gone(folder, error) from error


def _text(folder: Path) -> str:
    path = folder / MANIFEST
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError as error:
        problem = f"There is no {path}; check the folder, or plan a batch into it."
        raise WrongManifest(problem) from error
    except UnicodeDecodeError as error:
        raise WrongManifest(f"{path} is no text; {AGAIN}.") from error
    except OSError as error:
        raise gone(path, error) from error
    if not text.strip():
        raise WrongManifest(f"{path} is empty; {AGAIN}.")
    return text


def _settings(folder: Path, line: str) -> BatchSettings:
    path = folder / MANIFEST
    try:
        record = json.loads(line)
        its = record["version"]
        if its == version():  # of another version the rest may be another as well
            _require_sum(path, 1, record)
            return BatchSettings.of_record(record)
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise WrongManifest(f"{path}, line 1: that is no batch's first line; {AGAIN}.") from error
    raise OtherVersion(
        f"{path} is of Hangtime {its}, and this is {version()}: results of the two would be mixed. "
        "Go on with that version, or take another folder."
    )


def _cell(folder: Path, number: int, line: str) -> CellPlan:
    path = folder / MANIFEST
    try:
        record = json.loads(line)
        _require_sum(path, number, record)
        return CellPlan(**{**record, "state": State(record["state"])})
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise WrongManifest(f"{path}, line {number}: that is no cell; {AGAIN}.") from error


def _sum(record: dict[str, Any]) -> str:
    return hashlib.sha256(json.dumps(record).encode()).hexdigest()[:KEY_SHOWN]


def _require_sum(path: Path, number: int, record: dict[str, Any]) -> None:
    """Takes the sum out of a line's record. Raises WrongManifest where it is not the line's."""
    if record.pop(SUM) != _sum(record):
        raise WrongManifest(
            f"{path}, line {number} was changed after it was written; change clips and recipes "
            f"instead, and {AGAIN}."
        )


def _require_true(folder: Path, manifest: Manifest) -> None:
    """A line of another manifest is not what its name says beside this one's first line."""
    for cell in manifest.cells:
        number, _, key = cell.cell.partition("-")
        if not number.isdecimal() or key != cell.key(manifest.settings)[:KEY_SHOWN]:
            raise WrongManifest(
                f"{folder / MANIFEST}: the line of cell “{cell.cell}” is of another batch; {AGAIN}."
            )
    twice = [name for name, n in Counter(c.cell for c in manifest.cells).items() if n > 1]
    if twice:
        raise WrongManifest(f"{folder / MANIFEST} has cell “{twice[0]}” twice; {AGAIN}.")
