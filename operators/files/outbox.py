"""Files that appear in the output folder together or not at all."""

import os
from collections.abc import Iterable
from contextlib import suppress
from errno import EISDIR
from pathlib import Path
from tempfile import TemporaryFile
from types import TracebackType
from typing import BinaryIO

from ...solver.data.faults import NotWrittenOver, OutputFolderBusy, OutputNotWritable
from .lock import LOCK, WITHOUT, is_held, remove, remove_empty, take
from .record import FileRecord

PART = "unfinished-"
OWN_LOCK = f"{PART}lock"  # not a batch's, which may run in the same folder


class Outbox:
    """An output folder. Files are written under other names until `deliver` gives them their own.

    As a context it removes on leaving what was not delivered, and a folder that it made in vain.
    What ends it after files were delivered has a note that names them. Raises OutputNotWritable on
    entering where the folder cannot be made or written.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._made: list[Path] = []
        self._names: list[str] = []
        self._delivered: list[Path] = []
        self._lock: BinaryIO | None = None

    def __enter__(self) -> "Outbox":
        try:
            missing = [f for f in (self.folder, *self.folder.parents) if not f.exists()]
            self.folder.mkdir(parents=True, exist_ok=True)
            self._made = missing
            TemporaryFile(prefix=PART, dir=self.folder).close()
        except OSError as error:
            self._remove_made()
            raise not_writable(self.folder, error) from error
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if error is not None and self._delivered:
            error.add_note(f"written by then: {', '.join(map(str, self._delivered))}")
        try:
            for name in self._names:
                # The folder may have gone, or a file may have its name; on Windows it may be open.
                # What stays the next run removes, and it hides not why this one ended.
                with suppress(OSError):
                    self._part(name).unlink()
        finally:
            if self._lock is not None:
                remove(self.folder / OWN_LOCK, self._lock)
            self._remove_made()

    def claim(self, names: Iterable[str]) -> None:
        """Has the folder to itself until this is left, where the file system has locks, and removes
        what a run that was killed has left of the files with these names.

        Raises OutputFolderBusy, OutputNotWritable.
        """
        if is_held(self.folder / LOCK):
            raise OutputFolderBusy(str(self.folder))
        try:
            self._lock = self._taken()
        except BlockingIOError as error:
            raise OutputFolderBusy(str(self.folder)) from error
        except OSError as error:
            raise not_writable(self.folder / OWN_LOCK, error) from error
        for name in names:
            try:
                self._part(name).unlink(missing_ok=True)
            except OSError as error:
                raise not_writable(self._part(name), error) from error

    def path(self, name: str) -> Path:
        """The path to write the file to that shall be called `name`."""
        if name not in self._names:
            self._names.append(name)
        return self._part(name)

    def write_text(self, name: str, text: str) -> None:
        """Writes a whole text file. Raises OutputNotWritable."""
        try:
            self.path(name).write_text(text, encoding="utf-8")
        except OSError as error:
            raise not_writable(self.folder / name, error) from error

    def deliver(self) -> list[Path]:
        """Gives every file its name, in the order in which they were asked for.

        Raises OutputNotWritable.
        """
        for name in self._names:
            if (self.folder / name).is_dir():  # before any other gets its name
                raise OutputNotWritable(str(self.folder / name), os.strerror(EISDIR))
        for name in self._names:
            try:
                os.replace(self._part(name), self.folder / name)
            except OSError as error:
                raise not_writable(self.folder / name, error) from error
            self._delivered.append(self.folder / name)
        self._names = []
        self._made = []
        return list(self._delivered)

    def records(self) -> dict[str, FileRecord]:
        """How the files are written so far, by names. Raises OutputNotWritable."""
        found = {}
        for name in self._names:
            try:
                found[name] = FileRecord.of(self._part(name))
            except OSError as error:
                raise not_writable(self.folder / name, error) from error
        return found

    def _taken(self) -> BinaryIO | None:
        """The folder's lock; None where there can be none. Raises BlockingIOError, OSError."""
        path = self.folder / OWN_LOCK
        try:
            return _own(path)
        except PermissionError as error:  # another user's run is, or has left it
            if is_held(path):
                raise BlockingIOError(*error.args) from error
            remove_empty(path)
        with suppress(PermissionError):  # it cannot be removed either, and tells nothing
            return _own(path)
        return None

    def _part(self, name: str) -> Path:
        return self.folder / f"{PART}{name}"

    def _remove_made(self) -> None:
        """Takes back the folders made, deepest first, as far as nothing else is in them."""
        with suppress(OSError):
            for folder in self._made:
                folder.rmdir()
        self._made = []


def _own(path: Path) -> BinaryIO | None:
    """The lock at this path; None on a file system that has no locks. Raises OSError."""
    try:
        return take(path, wait=False)
    except OSError as error:
        if error.errno not in WITHOUT:
            raise
    remove_empty(path)
    return None


def not_writable(path: Path, error: OSError) -> OutputNotWritable:
    """The fault of a path that could not be written."""
    return OutputNotWritable(str(path), error.strerror or type(error).__name__)


def write_new(path: Path, text: str) -> None:
    """A text file where there is none. Raises NotWrittenOver, OutputNotWritable."""
    try:
        with path.open("x", encoding="utf-8") as file:
            file.write(text)
    except FileExistsError as error:
        raise NotWrittenOver(str(path)) from error
    except OSError as error:
        raise not_writable(path, error) from error
