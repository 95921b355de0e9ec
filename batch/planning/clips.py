"""Clips of a batch: files, folders and patterns to files, and their hashes."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterable, Sequence
from glob import glob
from pathlib import Path

from ...bridge.formats.acclaim import find_asf
from ...solver.data.faults import UnreadableClip
from ..records.faults import WrongPlan

IN_FOLDERS = (".bvh", ".amc", ".fbx")  # a .blend is taken where it is named itself
SUFFIXES = (*IN_FOLDERS, ".blend")


def find_clips(words: Sequence[str]) -> list[str]:
    """The clips that files, folders (with all below) and patterns mean: paths, each once, sorted
    within each word. Raises WrongPlan."""
    found: dict[Path, str] = {}
    for word in words:
        paths = _meant(word)
        if not paths:
            raise WrongPlan(
                f"No clip is meant by “{word}”: there is no such file, or no {_listed()} file in "
                "it. Check the path."
            )
        for path in paths:
            found.setdefault(path.resolve(), absolute(path))
    return list(found.values())


def _meant(word: str) -> list[Path]:
    path = Path(word)
    if path.is_file():
        if path.suffix.lower() not in SUFFIXES:
            raise WrongPlan(f"{path} is no recording; clips are {_listed()} and .blend files.")
        return [path]
    if path.is_dir():
        return _clips_of(each for each in path.rglob("*"))
    return _clips_of(Path(each) for each in glob(word, recursive=True))


def _clips_of(paths: Iterable[Path]) -> list[Path]:
    return sorted(p for p in paths if p.suffix.lower() in IN_FOLDERS and p.is_file())


def _listed() -> str:
    return ", ".join(IN_FOLDERS)


def absolute(path: str | Path) -> str:
    """A path as a manifest holds it. Raises WrongPlan where its name is no text."""
    made = Path(os.path.abspath(path)).as_posix()
    try:
        made.encode("utf-8")
    except UnicodeEncodeError as error:
        raise WrongPlan(f"The name of {made!a} is no text; give the file another name.") from error
    return made


def clip_files(path: str) -> tuple[Path, ...]:
    """A clip's file, and the skeleton that an AMC file needs, where there is one."""
    if not path.lower().endswith(".amc"):
        return (Path(path),)
    try:
        return Path(path), find_asf(path)
    except UnreadableClip:  # told when it is read
        return (Path(path),)


def clip_sha256(path: str) -> str:
    """SHA-256, hexadecimal, of a clip's files. Raises OSError where one cannot be read."""
    content = hashlib.sha256()
    for file in clip_files(path):
        content.update(file.read_bytes())
    return content.hexdigest()
