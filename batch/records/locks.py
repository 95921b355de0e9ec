"""Locks of a batch: of its folder, and of what its processes share."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ...operators.files.lock import LOCK, take
from .faults import FolderBusy, gone


@contextmanager
def held(path: Path) -> Iterator[None]:
    """Waits until no other process holds the lock. Raises OSError."""
    with take(path, wait=True):
        yield


@contextmanager
def batch_lock(folder: Path) -> Iterator[None]:
    """One batch at a time runs in a folder. Raises FolderBusy, FolderGone."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise gone(folder, error) from error
    try:
        file = take(folder / LOCK, wait=False)
    except BlockingIOError as error:
        raise FolderBusy(
            f"Another batch is running in {folder}; wait until it ends, or take another folder."
        ) from error
    except OSError as error:  # also of a file system without locks
        raise gone(folder / LOCK, error) from error
    with file:
        yield
