"""Locks of a batch: a file that one process holds; the system lets go of it when that ends."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from .faults import FolderBusy, gone

LOCK = ".lock"
_BYTE = 1 << 30  # that is locked on Windows: not one that anybody reads


@contextmanager
def held(path: Path) -> Iterator[None]:
    """Waits until no other process holds the lock. Raises OSError."""
    with path.open("ab") as file:
        _lock(file, wait=True)
        yield


@contextmanager
def batch_lock(folder: Path) -> Iterator[None]:
    """One batch at a time runs in a folder. Raises FolderBusy, FolderGone."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        file = (folder / LOCK).open("ab")
    except OSError as error:
        raise gone(folder, error) from error
    with file:
        try:
            _lock(file, wait=False)
        except (BlockingIOError, PermissionError) as error:  # the latter on Windows
            raise FolderBusy(
                f"Another batch is running in {folder}; wait until it ends, or take another folder."
            ) from error
        except OSError as error:  # a file system without locks
            raise gone(folder / LOCK, error) from error
        yield


def _lock(file: BinaryIO, *, wait: bool) -> None:
    """Raises OSError where it is held and one does not wait."""
    if sys.platform == "win32":
        import msvcrt

        file.seek(_BYTE)
        while True:
            try:
                msvcrt.locking(file.fileno(), msvcrt.LK_LOCK if wait else msvcrt.LK_NBLCK, 1)
            except OSError:
                if not wait:
                    raise
            else:
                return
    import fcntl

    fcntl.flock(file, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
