"""Names of clips and recipes for people."""

from __future__ import annotations

from collections.abc import Iterable
from os.path import commonpath
from pathlib import Path


def short_names(paths: Iterable[str]) -> dict[str, str]:
    """Each path from the folder on that all share, so that no two have one name."""
    distinct = dict.fromkeys(paths)
    folders = {str(Path(path).parent) for path in distinct if path}
    try:
        shared = commonpath(folders) if folders else ""
    except ValueError:  # on several drives, or some relative
        return {path: path for path in distinct}
    return {path: Path(path).relative_to(shared).as_posix() if path else "" for path in distinct}
