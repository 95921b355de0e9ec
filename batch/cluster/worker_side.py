"""What runs on a Dask worker: who it is, and a cell, in the batch's folder or away from it."""

from __future__ import annotations

import hashlib
import os
import platform
import shutil
import tempfile
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from enum import Enum
from functools import cache
from pathlib import Path, PurePosixPath

from distributed import get_worker

from ...solver.one_thread import ONE_THREAD, SOLVER_THREADS
from ..cells.cell import run_cell
from ..cells.fits import SharedFits
from ..records.aside import remove_abandoned
from ..records.manifest import BatchSettings, CellPlan, Manifest, version, write_manifest
from ..records.result import CELLS, FITS, CellResult, cell_folder

PACKAGE = Path(__file__).parents[2]
KEPT_FITS = 8  # on a worker's disk
COMPUTED_BY = ("solver", "bridge", "operators", "batch")  # folders whose code makes results
Files = Mapping[str, bytes]  # by their paths within a folder, with "/"


class Reach(Enum):
    """How a worker reaches the batch's folder."""

    SHARED = "shared"
    READ_ONLY = "read-only"
    NONE = "not seen"


@dataclass(frozen=True)
class Build:
    """What decides the bits of a result. code: SHA-256 of the package's files, by their paths."""

    version: str
    code: Mapping[str, str]
    libraries: Mapping[str, str]


@dataclass(frozen=True)
class WorkerState:
    """A worker as it sees itself. one_thread: whether linear algebra keeps to one."""

    build: Build
    reach: Reach
    one_thread: bool
    host: str


@dataclass(frozen=True)
class Delivery:
    """The end of a cell. files: of its folder, fits: new ones, where it was solved away from the
    batch's folder."""

    result: CellResult
    files: Files
    fits: Files


@cache
def own_build() -> Build:
    """Of this process."""
    import casadi
    import numpy
    import scipy_openblas32

    found = (path for name in COMPUTED_BY for path in (PACKAGE / name).rglob("*.py"))
    code = {
        path.relative_to(PACKAGE).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in found
    }
    libraries = {
        "numpy": numpy.__version__,
        "CasADi": casadi.CasadiMeta.version(),
        "OpenBLAS": scipy_openblas32.__version__,
    }
    return Build(version(), code, libraries)


def look_around(folder: str, token: str) -> WorkerState:
    """Who this worker is. folder: the batch's, empty where it is not to be used. token: name of a
    file that lies there."""
    os.environ[SOLVER_THREADS] = "1"  # a cell takes a core, others work on the rest
    one_thread = all(os.environ.get(name) == "1" for name in list(ONE_THREAD)[:2])
    return WorkerState(own_build(), _reach(folder, token), one_thread, platform.node())


def _reach(folder: str, token: str) -> Reach:
    if not folder or not (Path(folder) / token).is_file():
        return Reach.NONE
    try:
        (Path(folder) / CELLS).mkdir(exist_ok=True)
        with tempfile.TemporaryFile(dir=Path(folder) / CELLS):
            return Reach.SHARED
    except OSError:
        return Reach.READ_ONLY


class NotShared(Exception):
    """A worker that sees the batch's folder does not see a file that a cell reads."""

    def __init__(self, path: str) -> None:
        super().__init__(path)
        self.path = path

    def __str__(self) -> str:
        return f"{self.path} is not there"


def solve_in(folder: str, cell: str, paths: list[str]) -> Delivery:
    """A cell of a batch whose folder this worker shares. paths: of the files that it reads.

    Raises NotShared, BatchFault.
    """
    if unseen := [path for path in paths if not os.path.isfile(path)]:
        raise NotShared(unseen[0])
    return Delivery(run_cell(Path(folder), cell, fits_of(folder)), {}, {})


def solve_away(
    batch: str, settings: BatchSettings, plan: CellPlan, files: Files, fits: Files
) -> Delivery:
    """A cell whose files came as bytes, in a folder that lives as long as this takes.

    batch: tells batches apart. plan: its clip and recipe are among the files. fits: of its clip.
    """
    own = Path(get_worker().local_directory) / f"hangtime-{batch}"
    (own / FITS).mkdir(parents=True, exist_ok=True)
    kept = sorted((own / FITS).glob("[!.]*"), key=os.path.getmtime)
    for old in kept[:-KEPT_FITS]:  # of clips long done: the disk is not ours alone
        shutil.rmtree(old, ignore_errors=True)
    new = {name: content for name, content in fits.items() if not (own / FITS / name).exists()}
    write_files(own / FITS, new)
    before = {path.name for path in (own / FITS).glob("[!.]*")}
    with tempfile.TemporaryDirectory(prefix="cell-", dir=own) as scratch:
        folder = Path(scratch)
        write_files(folder / "files", files)
        clip, recipe = (str(folder / "files" / n) if n else "" for n in (plan.clip, plan.recipe))
        here = replace(plan, clip=clip, recipe=recipe)
        write_manifest(folder, Manifest(settings, (here,)))
        result = run_cell(folder, plan.cell, fits_of(str(own)))
        made = read_files(own / FITS)
        fitted = {name: made[name] for name in made if name.partition("/")[0] not in before}
        return Delivery(result, read_files(cell_folder(folder, plan.cell)), fitted)


@cache
def fits_of(folder: str) -> SharedFits:
    """The fits in a folder, kept in memory from one cell to the next."""
    return SharedFits(Path(folder))


def tidy(folder: str) -> None:
    """Remove from a batch's folder what processes of this machine left half-written that are no
    more."""
    for name in (CELLS, FITS):
        remove_abandoned(Path(folder) / name)


def write_files(folder: Path, files: Files) -> None:
    """Raises OSError, or ValueError for a path that leads out of the folder."""
    for name, content in files.items():
        parts = PurePosixPath(name)
        if parts.is_absolute() or ".." in parts.parts:
            raise ValueError(f"{name} leads out of {folder}")
        path = folder / parts
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)


def read_files(folder: Path) -> dict[str, bytes]:
    """Every file below a folder but for hidden ones; those that vanish meanwhile are left out."""
    found = {}
    for path in sorted(folder.rglob("*")):
        name = path.relative_to(folder)
        if path.is_file() and not any(part.startswith(".") for part in name.parts):
            with suppress(FileNotFoundError):
                found[name.as_posix()] = path.read_bytes()
    return found
