"""Line-based text reader: every complaint names its line."""

from collections.abc import Container
from math import isfinite
from pathlib import Path
from typing import NamedTuple, NoReturn

import numpy as np

from ...solver.arrays import FloatArray
from ...solver.data.faults import ClipNotOpened, NonFiniteKey, UnreadableClip
from .paths import require_readable

BYTE_ORDER_MARK = "\ufeff"


class Line(NamedTuple):
    """The words of one line that is not blank; number is 1-based."""

    number: int
    words: list[str]

    def starts(self, *keyword: str) -> bool:
        """True where the line's first words are these, in any case."""
        return tuple(w.lower() for w in self.words[: len(keyword)]) == keyword


class Reader:
    """A text file's lines that are not blank, taken one after another."""

    def __init__(self, path: Path) -> None:
        """Raises ClipNotOpened, or UnreadableClip where the file is not text."""
        self.path = path
        require_readable(path)
        try:
            data = path.read_bytes()
            text = data.decode("utf-8")
        except OSError as error:
            raise ClipNotOpened(str(path), error.strerror or str(error)) from error
        except UnicodeDecodeError as error:
            line = data.count(b"\n", 0, error.start) + 1
            raise UnreadableClip(str(path), line, "holds bytes that are not text") from error
        if text.startswith(BYTE_ORDER_MARK):  # Blender's importer cannot read past it
            problem = "begins with a byte order mark; save it as UTF-8 without one"
            raise UnreadableClip(str(path), 1, problem)
        numbered = [Line(n, s.split()) for n, s in enumerate(text.splitlines(), start=1)]
        self.lines = [line for line in numbered if line.words]
        self.next = 0

    @property
    def last_line(self) -> int:
        """Number of the last line that is not blank."""
        return self.lines[-1].number if self.lines else 1

    def peek(self) -> Line | None:
        """The line to come, None at the end."""
        return self.lines[self.next] if self.next < len(self.lines) else None

    def take(self, expected: str) -> Line:
        """The next line. Raises UnreadableClip (at the last line) where the file has ended."""
        line = self.peek()
        if line is None:
            self.fail(self.last_line, f"the file ends where {expected} should follow")
        self.next += 1
        return line

    def fail(self, line: int, problem: str) -> NoReturn:
        """Raises UnreadableClip for this file."""
        raise UnreadableClip(str(self.path), line, problem)

    def channels(self, line: int, words: list[str], known: Container[str]) -> list[str]:
        """Channels' names in lower case, each known and there once. Raises UnreadableClip."""
        names = [word.lower() for word in words]
        for name, word in zip(names, words, strict=True):
            if name not in known or names.count(name) > 1:
                self.fail(line, f"channel '{word}' is unknown or named twice")
        return names

    def numbers(self, line: int, words: list[str], count: int) -> FloatArray:
        """(count,) finite numbers from these words. Raises UnreadableClip."""
        values = self.keys(line, words, count)
        for word, value in zip(words, values, strict=True):
            if not isfinite(value):
                self.fail(line, f"'{word}' is not a finite number")
        return np.array(values)

    def keys(self, line: int, words: list[str], count: int) -> list[float]:
        """count numbers, NaN and infinity allowed. Raises UnreadableClip."""
        if len(words) != count:
            self.fail(line, f"{len(words)} values where {count} are needed")
        try:
            return [float(word) for word in words]
        except ValueError:
            bad = next(word for word in words if not _is_number(word))
            self.fail(line, f"'{bad}' is not a number")


def require_finite(table: FloatArray, owners: list[str]) -> None:
    """Raises NonFiniteKey for the first frame (counted from 1) of the (T, C) table that is not."""
    bad = np.argwhere(~np.isfinite(table))
    if len(bad):
        frame, column = bad[0]
        raise NonFiniteKey(owners[column], float(frame + 1))


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True
