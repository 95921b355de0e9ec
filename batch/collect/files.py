"""Files of a batch's folder, written aside, so that one with its name is whole."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from ..records.faults import gone


@contextmanager
def file_aside(path: Path) -> Iterator[Path]:
    """Where to write what becomes `path` at the end. Raises FolderGone."""
    aside = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        yield aside
        os.replace(aside, path)
    except OSError as error:
        raise gone(path, error) from error
    finally:
        with suppress(OSError):
            aside.unlink(missing_ok=True)
