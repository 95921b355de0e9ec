"""Clips of a batch: files, folders and patterns to files, and their hashes."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Collection, Iterable, Iterator, Sequence
from fnmatch import fnmatch
from glob import glob
from pathlib import Path

from ...bridge.formats.acclaim import clip_files
from ...bridge.formats.paths import AtPath, kind_of
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
    if not is_file(path):
        return files_meant(word, IN_FOLDERS, out)
    if path.suffix.lower() not in SUFFIXES:
        raise WrongPlan(f"{path} is no recording; clips are {_listed()} and .blend files.")
    return [path]


def is_file(path: Path) -> bool:
    """Whether a path that somebody named is a file's. Raises WrongPlan for what may not be looked
    at, for a name that is too long, and for a pipe or a device."""
    try:
        kind = kind_of(path)
    except OSError as error:
        raise WrongPlan(f"{path} cannot be read ({error.strerror}); check its path.") from error
    if kind is AtPath.OTHER:
        raise WrongPlan(f"{path} is a pipe or a device, and no file; name a file.")
    return kind is AtPath.FILE


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
    """The files in a folder and all below, also behind links, but for hidden ones and those of the
    batch's own. Each folder is gone into once, so that links in a circle end. Raises OSError for a
    folder that cannot be read: `rglob` passes it over, and its clips would be missing unsaid;
    WrongPlan for a link to nothing, likewise."""
    gone_into = {str(own), os.path.realpath(folder)}
    for parent, folders, names in os.walk(folder, onerror=_raise, followlinks=True):
        inside, folders[:] = sorted(folders), []
        for name in inside:
            real = os.path.realpath(os.path.join(parent, name))
            if not _hidden(name) and real not in gone_into:
                gone_into.add(real)
                folders.append(name)
        yield from _there(Path(parent, name) for name in names if not _hidden(name))


def _matching(pattern: str, own: Path) -> Iterator[Path]:
    """The files that a pattern means. Raises as `_below`, for the folders of a "**"."""
    words = pattern.replace(os.sep, "/").split("/")
    if "**" not in words:
        yield from _there(map(Path, glob(pattern)))
        return
    deep = words.index("**")
    above = "/".join(words[:deep])  # empty also of "/**"
    for top in map(Path, glob(f"{above}/") if above or deep else ["."]):
        for path in _below(top, own) if top.is_dir() else ():
            if _fits(path.relative_to(top).parts, words[deep:]):
                yield path


def _fits(parts: Sequence[str], words: Sequence[str]) -> bool:
    """Whether a path's parts are as a pattern's words say, of which "**" is any number of them."""
    if not words:
        return not parts
    if words[0] == "**":
        return any(_fits(parts[k:], words[1:]) for k in range(len(parts) + 1))
    return bool(parts) and fnmatch(parts[0], words[0]) and _fits(parts[1:], words[1:])


def _there(paths: Iterable[Path]) -> Iterator[Path]:
    """The same paths. Raises WrongPlan for a link to nothing."""
    for path in paths:
        if path.is_symlink() and not path.exists():
            raise WrongPlan(
                f"{path} is a link to {os.readlink(path)}, which is not there; mend or remove it."
            )
        yield path


def _hidden(name: str) -> bool:
    """Such as "._walk.bvh", which macOS leaves beside each file, and is no clip."""
    return name.startswith(".")


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
