"""Schema validation of a recipe's tables: typed access, refusals with their line."""

import difflib
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Any, NoReturn, TypeVar

from ...solver.data.contacts import COUNTED
from ...solver.data.faults import BadRecipe
from .source_lines import KeyPath

Word = TypeVar("Word", bound=Enum)


@dataclass(frozen=True)
class NumberRange:
    """Admissible range of a number, with its wording: "must be ..."."""

    words: str
    holds: Callable[[float], bool]


NUL = '"{}" holds the character NUL (\\u0000); leave that out'
MOST = 1e9  # of any key, in its unit
ANY_NUMBER = NumberRange("a number", lambda _: True)
ABOVE_ZERO = NumberRange("above zero", lambda value: value > 0.0)
NOT_NEGATIVE = NumberRange("zero or more", lambda value: value >= 0.0)


@dataclass(frozen=True)
class Source:
    """A recipe's path, for faults, and the line of each of its keys and elements."""

    path: str
    lines: Mapping[KeyPath, int]

    def refuse(self, place: KeyPath, problem: str) -> NoReturn:
        """Raises BadRecipe at the innermost part of the place that has a line, or what is in it."""
        for length in range(len(place), 0, -1):
            outer = place[:length]
            within = [line for at, line in self.lines.items() if at[:length] == outer]
            if within:
                raise BadRecipe(self.path, self.lines.get(outer, min(within)), problem)
        raise BadRecipe(self.path, None, problem)


@dataclass(frozen=True)
class Table:
    """One table of a recipe: its place, its values and the keys that it may hold.

    kind: what a key of it is called. Every method raises BadRecipe where a value does not fit.
    """

    source: Source
    place: KeyPath
    values: dict[str, Any]
    known: Sequence[str]
    kind: str = "key"

    def __post_init__(self) -> None:
        for key in self.values:
            if key not in self.known:
                near = difflib.get_close_matches(key.lower(), self.known, n=1)
                hint = f'did you mean "{near[0]}"?' if near else f"known: {listed(self.known)}"
                self.refuse(key, f'unknown {self.kind} "{key}"; {hint}')

    def refuse(self, key: str, problem: str) -> NoReturn:
        """Raises BadRecipe at one of the table's keys."""
        self.source.refuse((*self.place, key), problem)

    def not_both(self, key: str, others: Sequence[str]) -> None:
        """Refuses `key` beside any of the others, where the later of the two stands."""
        for other in others:
            if key in self.values and other in self.values:
                later = max(key, other, key=list(self.values).index)
                self.refuse(later, f'"{key}" and "{other}" exclude each other; keep one')

    def needs(self, keys: Sequence[str]) -> None:
        """Refuses the table where it has none of the keys."""
        if not any(key in self.values for key in keys):
            what = next((p for p in reversed(self.place) if isinstance(p, str)), "recipe")
            wanted = " or ".join(f'"{key}"' for key in keys)
            self.source.refuse(self.place, f"this {what} has no {wanted}; add it")

    def number(self, key: str, allowed: NumberRange = ANY_NUMBER) -> float | None:
        """A finite number that is allowed, None where absent."""
        if key not in self.values:
            return None
        value = self.values[key]
        if not _is_number(value):
            self.refuse(key, f'"{key}" must be a number, not {shown(value)}')
        self._meant(key, value)
        if not allowed.holds(float(value)):
            self.refuse(key, f'"{key}" must be {allowed.words}, not {value:g}')
        return float(value)

    def pair(self, key: str, form: str) -> tuple[float, float] | None:
        """Two finite numbers, None where absent; form: how they are written, "[first, last]"."""
        if key not in self.values:
            return None
        first, second = self._numbers(key, form)
        return first, second

    def vector(self, key: str) -> tuple[float, float, float] | None:
        """Three finite numbers, None where absent."""
        if key not in self.values:
            return None
        x, y, z = self._numbers(key, "[x, y, z]")
        return x, y, z

    def _numbers(self, key: str, form: str) -> list[float]:
        """As many finite numbers as `form` has."""
        value = self.values[key]
        right = isinstance(value, list) and len(value) == form.count(",") + 1
        if not right or not all(map(_is_number, value)):
            self.refuse(key, f'"{key}" must be {form} in finite numbers, not {shown(value)}')
        for each in value:
            self._meant(key, each)
        return list(map(float, value))

    def all_numbers(self, key: str) -> tuple[float, ...]:
        """Any number of finite numbers, but not none."""
        value = self.values[key]
        if not isinstance(value, list) or not value or not all(map(_is_number, value)):
            self.refuse(key, f'"{key}" must be finite numbers in brackets, not {shown(value)}')
        for each in value:
            self._meant(key, each)
        return tuple(map(float, value))

    def _meant(self, key: str, value: float) -> None:
        """Refuses a number that is beyond any amount, before something is computed from it."""
        if abs(value) > MOST:
            self.refuse(key, f'"{key}" is {value:g}; no amount in a recipe is beyond {MOST:g}')

    def word(self, key: str) -> str | None:
        """A text that is not empty, None where absent."""
        if key not in self.values:
            return None
        value = self.values[key]
        if not isinstance(value, str) or not value.strip():
            self.refuse(key, f'"{key}" must be a text in quotes, not {shown(value)}')
        if "\0" in value:  # which no file and no bone can be called
            self.refuse(key, NUL.format(key))
        return value

    def phase(self, key: str) -> str | None:
        """A phase's name: that of the analysis whatever the capitals, or a hold's. None where
        absent."""
        word = self.word(key)
        if word is None:
            return None
        plain = " ".join(word.casefold().split())
        return plain if COUNTED.fullmatch(plain) else word

    def needed_word(self, key: str) -> str:
        """A text that must be there."""
        self.needs((key,))
        return self.word(key) or ""

    def choice(self, key: str, of: type[Word]) -> Word | None:
        """The member of an enum whose value is written, None where absent."""
        word = self.word(key)
        members = {str(member.value): member for member in of}
        if word is not None and word not in members:
            what = key.replace("_", " ")
            self.refuse(key, f'unknown {what} "{word}"; known: {listed(list(members))}')
        return None if word is None else members[word]

    def words(self, key: str) -> tuple[str, ...]:
        """Texts, none where absent."""
        value = self.values.get(key, [])
        if not isinstance(value, list) or (key in self.values and not value):
            self.refuse(key, f'"{key}" must be a list of names in brackets, not {shown(value)}')
        for i, name in enumerate(value):
            if not isinstance(name, str) or not name.strip():
                problem = f'"{key}" must hold names in quotes, not {shown(name)}'
                self.source.refuse((*self.place, key, i), problem)
            if "\0" in name:
                self.source.refuse((*self.place, key, i), NUL.format(key))
        return tuple(value)

    def flag(self, key: str) -> bool:
        """true or false; false where absent."""
        value = self.values.get(key, False)
        if not isinstance(value, bool):
            self.refuse(key, f'"{key}" must be true or false, not {shown(value)}')
        return value

    def table(self, key: str, known: Sequence[str], kind: str) -> "Table":
        """A table inside, empty where absent."""
        value = self.values.get(key, {})
        if not isinstance(value, dict):
            self.refuse(key, f'"{key}" must be a table, [{key}], not {shown(value)}')
        return Table(self.source, (*self.place, key), value, known, kind)

    def tables(self, key: str, known: Sequence[str]) -> list["Table"]:
        """The tables of an array, none where absent."""
        header = ".".join(str(p) for p in (*self.place, key) if isinstance(p, str))
        form = f"write every {key} as a table of its own, under [[{header}]]"
        return self.inner((key,), self.values.get(key, []), known, form)

    def inner(
        self, place: KeyPath, values: object, known: Sequence[str], form: str
    ) -> list["Table"]:
        """The tables of an array at a place inside; form: how it is to be written."""
        place = (*self.place, *place)
        if not isinstance(values, list) or not all(isinstance(v, dict) for v in values):
            self.source.refuse(place, form)
        return [Table(self.source, (*place, i), v, known) for i, v in enumerate(values)]


def _is_number(value: object) -> bool:
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    try:
        return math.isfinite(float(value))
    except OverflowError:
        return False


def listed(words: Sequence[str]) -> str:
    """Words with commas between."""
    return ", ".join(words)


def shown(value: object) -> str:
    """A value as a person would write it, cut short."""
    match value:
        case bool():
            text = str(value).lower()
        case str():
            text = f'"{value}"'
        case dict():
            text = "a table"
        case list():
            nested = any(isinstance(v, dict | list) for v in value)
            text = "a list" if nested else f"[{', '.join(map(shown, value))}]"
        case _:
            text = str(value)
    return text if len(text) <= 40 else f"{text[:37]}..."
