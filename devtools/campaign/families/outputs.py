"""Outputs where the disk is full, or the folder goes away while they are written."""

import resource
import shutil
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from ....operators.files.outbox import Outbox
from ....solver.data.faults import Fault
from ..protocol.case import Changed, Family, HostileCase, LeftBehind

NAMES = ("report.json", "report.txt", "trajectory.npz", "adapted.fbx")


@contextmanager
def largest_file(size: int) -> Iterator[None]:
    """Context in which no file grows beyond a size, as on a full disk."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    usual = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
        signal.signal(signal.SIGXFSZ, usual)


def outbox(case: HostileCase) -> None:
    """Files that appear together or not at all; what lay there before stays as it was."""
    folder = case.folder / "a" / "b"
    old = case.chance(0.5)
    if old:
        folder.mkdir(parents=True)
        (folder / "report.txt").write_text("before", encoding="utf-8")
    try:
        with largest_file(int(case.rng.integers(0, 3000)) if case.chance(0.7) else 10**6):
            _write(case, folder)
    except Fault:
        left = {path.name for path in case.folder.rglob("*") if path.is_file()}
        if left - {"report.txt", "b"}:  # what was there, and what a hostile step has put there
            raise LeftBehind(", ".join(left)) from None
        kept = folder / "report.txt"
        if kept.is_file() and kept.read_text(encoding="utf-8") != "before":
            raise Changed("report.txt") from None
        raise


def _write(case: HostileCase, folder: Path) -> None:
    hostile = case.pick(HOSTILE) if case.chance(0.6) else None
    with Outbox(folder) as box:
        for i in range(int(case.rng.integers(1, 5))):
            if hostile is not None and case.chance(0.4):
                hostile(folder)
            box.write_text(NAMES[i], "x" * int(case.rng.integers(0, 4000)))
            case.taken_on = True
        if hostile is not None and case.chance(0.4):
            hostile(folder)
        box.deliver()


def _gone(folder: Path) -> None:
    shutil.rmtree(folder, ignore_errors=True)


def _file_instead(folder: Path) -> None:
    if folder.is_dir():
        shutil.rmtree(folder)
        folder.touch()


def _taken(folder: Path) -> None:
    """A folder where a file should go."""
    if folder.is_dir() and not (folder / NAMES[1]).is_dir():
        (folder / NAMES[1]).unlink(missing_ok=True)
        (folder / NAMES[1]).mkdir()


HOSTILE: tuple[Callable[[Path], None], ...] = (_gone, _file_instead, _taken)

FAMILIES = (Family("output folders", 5.0, 10.0, outbox),)
