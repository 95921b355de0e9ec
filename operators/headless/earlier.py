"""Files of an earlier run in the output folder: removed where nobody has changed them since."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from pathlib import Path

from ..files.record import FileRecord
from .result_files import REPORTS


def listed_files(folder: Path) -> dict[str, FileRecord]:
    """What the folder's report says that its run wrote, by names; nothing where there is none, or
    one of a version that did not list it."""
    try:
        report = json.loads((folder / REPORTS[0]).read_text(encoding="utf-8"))
        listed: Mapping[str, Mapping[str, object]] = report["files"]
        return {name: _record(each) for name, each in listed.items()}
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return {}


def _record(each: Mapping[str, object]) -> FileRecord:
    return FileRecord(int(str(each["bytes"])), str(each["sha256"]))


def clear(paths: Iterable[Path], listed: Mapping[str, FileRecord]) -> list[str]:
    """Removes the files at these paths that are as an earlier run has listed them; lines that tell
    of it, and of those that stay. Never fails: the new result is there."""
    removed, left = [], []
    for path in paths:
        try:
            if not path.is_file():
                continue
            why = _reason_to_stay(path, listed)
            if why is None:
                path.unlink()
                removed.append(f"  {path}")
            else:
                left.append(f"Left as it is, since {why}: {path}")
        except OSError as error:
            reason = error.strerror or type(error).__name__
            left.append(f"Of an earlier run, but it cannot be removed ({reason}): {path}")
    return [*(["Removed, as of an earlier run:", *removed] if removed else []), *left]


def _reason_to_stay(path: Path, listed: Mapping[str, FileRecord]) -> str | None:
    """None of what an earlier run wrote and nobody has changed. Raises OSError."""
    if path.name not in listed:
        return "no report in its folder lists it"
    if FileRecord.of(path) != listed[path.name]:
        return "it was changed after it was written"
    return None
