"""Locks: a file that one process holds; the system lets go of it when that ends."""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO

LOCK = ".lock"
_BYTE = 1 << 30  # that is locked on Windows: not one that anybody reads


def take(path: Path, *, wait: bool) -> BinaryIO:
    """The file at this path, locked until it is closed.

    Raises BlockingIOError where another process holds it and one does not wait; OSError.
    """
    while True:
        file = path.open("ab")
        try:
            _lock(file, wait=wait)
            if _is_at(path, file):
                return file
        except BaseException:
            file.close()
            raise
        file.close()  # who held it has removed it meanwhile


def remove(path: Path, file: BinaryIO) -> None:
    """Lets go of a lock, and leaves no file."""
    if sys.platform == "win32":  # where nobody removes what is open
        file.close()
    with suppress(OSError):
        path.unlink()
    file.close()


def _is_at(path: Path, file: BinaryIO) -> bool:
    try:
        return os.path.samestat(os.fstat(file.fileno()), path.stat())
    except FileNotFoundError:
        return False


def _lock(file: BinaryIO, *, wait: bool) -> None:
    if sys.platform == "win32":
        import msvcrt

        file.seek(_BYTE)
        while True:
            try:
                msvcrt.locking(file.fileno(), msvcrt.LK_LOCK if wait else msvcrt.LK_NBLCK, 1)
            except OSError as error:
                if not wait:
                    raise BlockingIOError(*error.args) from error
            else:
                return
    import fcntl

    fcntl.flock(file, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
