"""What a cell reads, to be sent where its files are not; and what it made, brought back."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path, PurePosixPath

from ..cells.work import InputChanged, cell_files, changed
from ..records.aside import written_aside
from ..records.faults import FolderGone, gone
from ..records.manifest import CellPlan
from ..records.result import FITS, lasting_result, written_cell
from .worker_side import Files, write_files

CLIP = "clip.sha256"  # within a fit's folder: whose it is


@dataclass(frozen=True)
class Parcel:
    """A cell for elsewhere. plan: with clip and recipe as they are called in `files`."""

    plan: CellPlan
    files: Mapping[str, Path]


def parcel_of(plan: CellPlan) -> Parcel:
    """The files that a cell reads, laid out to each other as they are here. Raises InputChanged
    where one is not there, FolderGone."""
    paths = [Path(os.path.abspath(path)) for path in cell_files(plan)]
    if missing := [path for path in paths if not path.is_file()]:
        raise InputChanged(changed(str(missing[0])))
    try:
        root = Path(os.path.commonpath([path.parent for path in paths]))
    except ValueError as error:  # on drives without a common root
        raise FolderGone(f"The files of cell {plan.cell} cannot be sent: {error}.") from error
    names = {path.relative_to(root).as_posix(): path for path in paths}
    clip, recipe = (os.path.abspath(path) if path else "" for path in (plan.clip, plan.recipe))
    called = {str(path): name for name, path in names.items()} | {"": ""}
    return Parcel(replace(plan, clip=called[clip], recipe=called[recipe]), names)


def deliver_cell(folder: Path, cell: str, files: Files) -> None:
    """Lay a cell's folder into the batch's, whole. One that is there stays, but a failed one's.

    Raises FolderGone.
    """
    if lasting_result(folder, cell) is None:
        with written_cell(folder, cell) as aside:
            write_files(aside, files)


def deliver_fits(folder: Path, files: Files, clip_sha256: str) -> None:
    """Lay fits of a clip into the batch's folder, each whole; those that are there stay.

    Raises FolderGone.
    """
    by_fit: dict[str, dict[str, bytes]] = {}
    for name, content in files.items():
        fit, *rest = PurePosixPath(name).parts
        by_fit.setdefault(fit, {CLIP: clip_sha256.encode()})["/".join(rest)] = content
    for fit, own in by_fit.items():
        if not (folder / FITS / fit).exists():
            try:
                with written_aside(folder / FITS / fit) as aside:
                    write_files(aside, own)
            except OSError as error:
                raise gone(folder, error) from error


def fits_by_clip(folder: Path) -> dict[str, set[str]]:
    """Names of fits in the batch's folder that were delivered, by their clips' hashes."""
    found: dict[str, set[str]] = {}
    for path in (folder / FITS).glob(f"*/{CLIP}"):
        found.setdefault(path.read_text(), set()).add(path.parent.name)
    return found
