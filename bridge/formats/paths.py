"""What lies at a path that somebody named; `Path.exists` and its like raise errors of the system
where that cannot be asked, and what is no file may never end."""

from __future__ import annotations

import os
from enum import Enum, auto
from errno import EINVAL
from pathlib import Path
from stat import S_ISDIR, S_ISREG

from ...solver.data.faults import ClipNotOpened


class AtPath(Enum):
    """What lies at a path; OTHER are pipes and devices."""

    NOTHING = auto()
    FILE = auto()
    FOLDER = auto()
    OTHER = auto()


def kind_of(path: str | Path) -> AtPath:
    """What lies there. Raises OSError where the system does not tell, as of what is below a folder
    that may not be read, and of names that are too long."""
    try:
        mode = os.stat(path).st_mode
    except (FileNotFoundError, NotADirectoryError):
        return AtPath.NOTHING
    except ValueError:  # a NUL
        return AtPath.NOTHING
    except OSError as error:
        if error.errno == EINVAL:  # a name that none can have, as of a pattern on Windows
            return AtPath.NOTHING
        raise
    if S_ISREG(mode):
        return AtPath.FILE
    return AtPath.FOLDER if S_ISDIR(mode) else AtPath.OTHER


UNFIT = {
    AtPath.NOTHING: "there is no such file",
    AtPath.FOLDER: "it is a folder",
    AtPath.OTHER: "it is a pipe or a device, and no file",
}


def unreadable(path: str | Path) -> str | None:
    """Why no file can be read there, in words that go into a sentence; None where one can."""
    try:
        kind = kind_of(path)
        if kind is AtPath.FILE:
            with open(path, "rb"):
                return None
    except OSError as error:
        return error.strerror or type(error).__name__
    return UNFIT[kind]


def no_folder(path: str | Path) -> str | None:
    """Why there is no folder that can be listed, as of `unreadable`; None where there is one."""
    try:
        os.scandir(path).close()
    except OSError as error:
        return error.strerror or type(error).__name__
    return None


def require_readable(clip: str | Path) -> None:
    """Raises ClipNotOpened where a recording's path is that of no file that can be read."""
    problem = unreadable(clip)
    if problem is not None:
        raise ClipNotOpened(str(clip), problem)


def are_one_file(path: str | Path, other: str | Path) -> bool:
    """Whether the same file is at both paths. What cannot be asked is told by who opens it."""
    try:
        return os.path.samefile(path, other)
    except (OSError, ValueError):
        return False
