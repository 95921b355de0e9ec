"""Folders that appear under their name whole or not at all."""

from __future__ import annotations

import os
import shutil
import socket
import tempfile
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext, suppress
from errno import EEXIST, ENOTEMPTY
from pathlib import Path

_NO_TURN = nullcontext()


@contextmanager
def written_aside(target: Path, turn: AbstractContextManager[None] = _NO_TURN) -> Iterator[Path]:
    """A folder to write into, which gets the target's name at the end.

    Where another process was quicker its folder stays, and this one is dropped. turn: entered
    about the renaming. Raises OSError.
    """
    target.parent.mkdir(parents=True, exist_ok=True)
    aside = _beside(target)
    try:
        os.chmod(aside, 0o755)  # a colleague may look
        yield aside
        for path in aside.rglob("*"):
            if path.is_file():
                _onto_disk(path)
        with turn:
            try:
                os.rename(aside, target)
            except OSError as error:
                # Or it was renamed, and a server on the network was asked twice.
                if error.errno not in (EEXIST, ENOTEMPTY) and not target.is_dir():
                    raise
    finally:
        shutil.rmtree(aside, ignore_errors=True)


def removed(target: Path) -> None:
    """Away with a folder, whole at once: its name is free even where files in it are still open,
    which file systems on a network then keep. Raises OSError."""
    if target.exists():
        aside = _beside(target)
        os.rename(target, aside / "old")
        shutil.rmtree(aside, ignore_errors=True)  # what stays is `remove_abandoned`'s


def _beside(target: Path) -> Path:
    """A new folder beside it whose name tells which process it is of."""
    prefix = f".{target.name}.{socket.gethostname()}.{os.getpid()}."
    return Path(tempfile.mkdtemp(prefix=prefix, dir=target.parent))


def _onto_disk(path: Path) -> None:
    """Else a power cut might leave the name, and of what is in the file only some."""
    with path.open("r+b") as file:  # Windows lets no other mode
        os.fsync(file.fileno())


def remove_abandoned(folder: Path) -> None:
    """Removes what processes of this machine left half-written that are no more."""
    with suppress(FileNotFoundError):
        for path in folder.iterdir():
            host, _, pid = path.name.rpartition(".")[0].rpartition(".")
            mine = path.name.startswith(".") and host.endswith(f".{socket.gethostname()}")
            if mine and pid.isdecimal() and not _alive(int(pid)):
                shutil.rmtree(path, ignore_errors=True)


def _alive(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except OSError:  # it is somebody else's
        return True
    return True
