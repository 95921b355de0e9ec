"""Clips of a batch: files, folders and patterns to files, and their hashes."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Collection, Iterator, Sequence
from glob import glob, has_magic
from pathlib import Path

from ...bridge.formats.acclaim import clip_files
from ..records.faults import WrongPlan

IN_FOLDERS = (".bvh", ".amc", ".fbx")  # a .blend is taken where it is named itself
SUFFIXES = (*IN_FOLDERS, ".blend")


def find_clips(words: Sequence[str], out: Path) -> list[str]:
    """The clips that files, folders (with all below) and patterns mean: paths, each once, sorted
    within each word. out: the batch's folder, in which only results lie. Raises WrongPlan."""
    found: dict[Path, str] = {}
    for word in words:
        paths = _meant(word, out)
        if not paths:
            raise WrongPlan(
                f"No clip is meant by “{word}”: there is no such file, or no {_listed()} file in "
                "it. Check the path."
            )
        for path in paths:
            found.setdefault(path.resolve(), absolute(path))
    return list(found.values())


def _meant(word: str, out: Path) -> list[Path]:
    path = Path(word)
    if path.is_file():
        if path.suffix.lower() not in SUFFIXES:
            raise WrongPlan(f"{path} is no recording; clips are {_listed()} and .blend files.")
        return [path]
    return files_meant(word, IN_FOLDERS, out)


def files_meant(word: str, suffixes: Collection[str], out: Path) -> list[Path]:
    """The files with such suffixes that a folder (with all below) or a pattern means, sorted; none
    of the batch's own folder. Raises WrongPlan."""
    path, own = Path(word), out.resolve()
    try:
        inside = _below(path, own) if path.is_dir() else _matching(word, own)
        files = [p for p in inside if p.suffix.lower() in suffixes and p.is_file()]
    except OSError as error:
        raise WrongPlan(
            f"{error.filename} cannot be read ({error.strerror}); allow reading it, or name the "
            "files and folders beside it one by one."
        ) from error
    return sorted(p for p in files if not p.resolve().is_relative_to(own))


def _below(folder: Path, own: Path) -> Iterator[Path]:
    """The files in a folder and all below, but for those of the batch's own. Raises OSError for a
    folder that cannot be read: `rglob` passes it over, and its clips would be missing unsaid."""
    for parent, folders, names in os.walk(folder, onerror=_raise):
        folders[:] = [name for name in folders if Path(parent, name).resolve() != own]
        yield from (Path(parent, name) for name in names)


def _matching(pattern: str, own: Path) -> Iterator[Path]:
    """The files that a pattern means. Raises OSError as `_below`, for the folders of a "**"."""
    before, deep, _ = pattern.partition("**")
    top = Path(os.path.dirname(before))
    if deep and not has_magic(before) and top.is_dir():
        for _ in _below(top, own):
            pass
    return map(Path, glob(pattern, recursive=True))


def _raise(error: OSError) -> None:
    raise error


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


def clip_sha256(path: str) -> str:
    """SHA-256, hexadecimal, of a clip's files. Raises OSError where one cannot be read."""
    content = hashlib.sha256()
    for file in clip_files(path):
        content.update(file.read_bytes())
    return content.hexdigest()
