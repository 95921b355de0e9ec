"""Source map of a TOML or JSON text: the line of each key and each array element.

The standard parsers do not tell. The text has been parsed before: what is wrong in it is not
noticed here.
"""

import json
import re
import tomllib
from collections.abc import Callable

KeyPath = tuple[str | int, ...]

_BARE = re.compile(r"[A-Za-z0-9_+.:-]+(?: \d\d:[0-9:.Z+-]+)?")  # numbers, words, dates
_STRING = re.compile(
    r'"""(?:\\.|[^\\])*?"{3,5}'
    r"|'''.*?'{3,5}"
    r'|"(?:\\.|[^"\\])*"'
    r"|'[^']*'",
    re.DOTALL,
)
_BLANK = re.compile(r"(?:[ \t\r\n]|#[^\n]*)*")
_SPACE = re.compile(r"[ \t]*")
_WORD = re.compile(r"[A-Za-z0-9_-]+")


def toml_lines(text: str) -> list[tuple[KeyPath, int]]:
    """Every key and array element of a valid TOML text with its line, counted from 1, in order.

    ("pin", 1, "phase") is the phase of the second [[pin]].
    """
    return _Cursor(text, lambda key: tomllib.loads(f"key = {key}")["key"]).toml()


def json_lines(text: str) -> list[tuple[KeyPath, int]]:
    """Like `toml_lines`, of a valid JSON text; a key that occurs twice is there twice."""
    return _Cursor(text, json.loads).json()


class _Cursor:
    """Cursor over a text that notes the lines of keys and values."""

    def __init__(self, text: str, unquote: Callable[[str], str]) -> None:
        self.text = text
        self.unquote = unquote
        self.at = 0
        self.found: list[tuple[KeyPath, int]] = []
        self.tables: dict[KeyPath, int] = {}  # how many [[tables]] of a path there are

    def json(self) -> list[tuple[KeyPath, int]]:
        self._skip(_BLANK)
        self._value(())
        return self.found

    def toml(self) -> list[tuple[KeyPath, int]]:
        table: KeyPath = ()
        self._skip(_BLANK)
        while self.at < len(self.text):
            if self.text.startswith("[", self.at):
                table = self._header()
            else:
                self._pair(table)
            self._skip(_BLANK)
        return self.found

    def _note(self, path: KeyPath, at: int) -> None:
        self.found.append((path, self.text.count("\n", 0, at) + 1))

    def _skip(self, pattern: re.Pattern[str]) -> str:
        """Moves over what matches here, which may be nothing, and returns it."""
        match = pattern.match(self.text, self.at)
        self.at = match.end() if match else self.at
        return match[0] if match else ""

    def _header(self) -> KeyPath:
        """[table] or [[table]]; inside an array of tables its last element is meant."""
        start = self.at
        repeated = self.text.startswith("[[", self.at)
        self.at += 2 if repeated else 1
        *parents, last = self._dotted()
        path: KeyPath = ()
        for key in parents:
            path = self._entered((*path, key))
        path = (*path, last)
        if repeated:
            self.tables[path] = self.tables.get(path, 0) + 1
        path = self._entered(path)
        self._note(path, start)
        self._skip(_SPACE)
        self.at += 2 if repeated else 1
        return path

    def _entered(self, path: KeyPath) -> KeyPath:
        return (*path, self.tables[path] - 1) if path in self.tables else path

    def _dotted(self) -> list[str]:
        """One key or several with dots between."""
        keys = []
        while True:
            self._skip(_BLANK)
            keys.append(self._key())
            self._skip(_SPACE)
            if not self.text.startswith(".", self.at):
                return keys
            self.at += 1

    def _key(self) -> str:
        quoted = self._skip(_STRING)
        return self.unquote(quoted) if quoted else self._skip(_WORD)

    def _pair(self, table: KeyPath) -> None:
        """key = value, or "key": value."""
        start = self.at
        path = (*table, *self._dotted())
        self._note(path, start)
        self._skip(_BLANK)
        self.at += 1
        self._skip(_BLANK)
        self._value(path)

    def _value(self, path: KeyPath) -> None:
        if self.text.startswith("{", self.at):
            self._members("}", lambda _: self._pair(path))
        elif self.text.startswith("[", self.at):
            self._members("]", lambda i: self._element((*path, i)))
        elif not self._skip(_STRING):
            self._skip(_BARE)

    def _element(self, path: KeyPath) -> None:
        self._note(path, self.at)
        self._value(path)

    def _members(self, close: str, member: Callable[[int], None]) -> None:
        """Members between brackets, with commas between."""
        self.at += 1
        count = 0
        self._skip(_BLANK)
        while not self.text.startswith(close, self.at):
            member(count)
            count += 1
            self._skip(_BLANK)
            if self.text.startswith(",", self.at):
                self.at += 1
                self._skip(_BLANK)
        self.at += 1
