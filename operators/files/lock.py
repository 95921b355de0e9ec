"""Locks: a file that one process holds; the system lets go of it when that ends."""

from __future__ import annotations

import errno
import os
import sys
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO

LOCK = ".lock"  # of a batch, in its folder
TRIES = 10  # at a file that others remove meanwhile
WITHOUT = {errno.ENOSYS, errno.ENOLCK, errno.EOPNOTSUPP, errno.EINVAL}  # of file systems, no locks
_BUSY = {errno.EACCES, errno.EDEADLK}  # as Windows says that another holds it
_BYTE = 1 << 30  # that is locked on Windows: not one that anybody reads


def take(path: Path, *, wait: bool) -> BinaryIO:
    """The file at this path, locked until it is closed.

    Raises BlockingIOError where another process holds it and one does not wait; OSError.
    """
    for tries_left in reversed(range(TRIES)):
        file = path.open("ab")
        try:
            _lock(file, wait=wait)
            # There are file systems that never tell a file by its number: then the last one counts.
            if not tries_left or _is_at(path, file):
                break
        except BaseException:
            file.close()
            raise
        file.close()  # who held it has removed it meanwhile
    return file


def is_held(path: Path) -> bool:
    """Whether another process holds the lock at this path, where that can be told."""
    try:
        if not path.is_file():  # a pipe would be waited for
            return False
        with path.open("rb") as file:
            _lock(file, wait=False)
    except BlockingIOError:
        return True
    except OSError:
        return False
    return False


def remove(path: Path, file: BinaryIO) -> None:
    """Lets go of a lock, and leaves no file."""
    if sys.platform == "win32":  # where nobody removes what is open
        file.close()
    remove_empty(path)
    file.close()


def remove_empty(path: Path) -> None:
    """Removes a lock's file, where that is possible; one that holds anything is somebody's own."""
    with suppress(OSError):
        if path.stat().st_size == 0:
            path.unlink()


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
                if error.errno not in _BUSY:
                    raise
                if not wait:
                    raise BlockingIOError(*error.args) from error
            else:
                return
    import fcntl

    fcntl.flock(file, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
