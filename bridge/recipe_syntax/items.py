"""Bidirectional mapping between the keys of a recipe's tables and the fields of records."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Any, Generic, TypeVar

from ...solver.data.requests import Moment, When
from .table import ANY_NUMBER, NOT_NEGATIVE, NumberRange, Table, shown
from .toml_text import degrees, entries

Values = dict[str, Any]
Record = TypeVar("Record")

LEAST_LENGTH = 1e-6  # of a direction; shorter ones are zero, or a slip
TURNS = NumberRange("from -360 to 360 degrees", lambda value: -360.0 <= value <= 360.0)
TRAVEL_KEYS = ("forward", "left", "up")
AGAINST = ("back", "right", "down")  # the other way along each
TRAVEL_WORDS = (*TRAVEL_KEYS, *AGAINST)


@dataclass(frozen=True)
class Item:
    """Mapping between some keys of a table and fields of its record.

    read: the record's fields that the keys say, by name; those that are left out keep their
    default. Raises BadRecipe. write: the other way, from the record to the keys.
    """

    keys: tuple[str, ...]
    read: Callable[[Table], Values]
    write: Callable[[Any], Values]


@dataclass(frozen=True)
class Kind(Generic[Record]):
    """Schema of one kind of table, and the record that it is read as.

    needs: groups of keys of each of which one must be there. excludes: keys, the first of which
    must not stand beside any of the others. named: whether it has a name of the artist's.
    """

    header: str
    record: Callable[..., Record]
    items: tuple[Item, ...]
    needs: tuple[tuple[str, ...], ...] = ()
    excludes: tuple[tuple[str, ...], ...] = ()
    named: bool = True

    @property
    def keys(self) -> tuple[str, ...]:
        """The keys that such a table may hold."""
        keys = tuple(key for item in self.items for key in item.keys)
        return ("name", *keys) if self.named else keys

    def read_all(self, top: Table) -> tuple[Record, ...]:
        """The records of all tables of this kind. Raises BadRecipe."""
        tables = enumerate(top.tables(self.header, self.keys))
        return tuple(self._read(table, self.default_name(i)) for i, table in tables)

    def read(self, inside: Table) -> Record:
        """The record of the one table of this kind, empty where absent. Raises BadRecipe."""
        return self._read(inside.table(self.header, self.keys, "key"), "")

    def default_name(self, i: int) -> str:
        """Default name of the i-th (from 0) record."""
        return f"{self.header.capitalize()} {i + 1}"

    def write(self, record: Record) -> Values:
        """The values of a record's table."""
        values = {"name": record.name} if self.named else {}  # type: ignore[attr-defined]
        for item in self.items:
            values |= item.write(record)
        return {key: value for key, value in values.items() if value is not None}

    def text(self, records: Sequence[Record]) -> list[str]:
        """TOML tables, one a record."""
        return [f"[[{self.header}]]\n{entries(self.write(record))}" for record in records]

    def _read(self, table: Table, default_name: str) -> Record:
        for group in self.needs:
            table.needs(group)
        for first, *others in self.excludes:
            table.not_both(first, others)
        fields: Values = {"name": table.word("name") or default_name} if self.named else {}
        for item in self.items:
            fields |= item.read(table)
        return self.record(**fields)


# ---------------------------------------------------------------- of one key


def one(
    key: str,
    read: Callable[[Table, str], Any],
    write: Callable[[Any], object] = lambda value: value,
    attribute: str | None = None,
) -> Item:
    """A key that says one field, by default of the same name; not written where at its default."""
    field = attribute or key

    def reading(table: Table) -> Values:
        return {field: read(table, key)} if key in table.values else {}

    def writing(record: Any) -> Values:
        value = getattr(record, field)
        # A default is an attribute of the class, too; where it has none, the key is needed.
        return {} if value == getattr(type(record), field, None) else {key: write(value)}

    return Item((key,), reading, writing)


def word(key: str) -> Item:
    """A text."""
    return one(key, Table.word)


def phase(key: str) -> Item:
    """The name of a phase."""
    return one(key, Table.phase)


def flag(key: str) -> Item:
    """true or false."""
    return one(key, Table.flag)


def number(key: str, allowed: NumberRange = ANY_NUMBER, attribute: str | None = None) -> Item:
    """A number."""
    return one(key, lambda table, key: table.number(key, allowed), attribute=attribute)


def whole(key: str, allowed: NumberRange) -> Item:
    """A whole number; `allowed` must hold no other."""
    return one(key, lambda table, key: int(table.number(key, allowed) or 0))


def angle(key: str, allowed: NumberRange = ANY_NUMBER) -> Item:
    """Degrees in the recipe, in which `allowed` is; rad in the record."""
    return one(key, lambda table, key: math.radians(table.number(key, allowed) or 0.0), degrees)


def vector(key: str) -> Item:
    """A place or an offset."""
    return one(key, Table.vector)


def direction(table: Table, key: str) -> tuple[float, float, float] | None:
    """A vector that points somewhere; as long as it is written."""
    values = table.vector(key)
    if values is not None and math.hypot(*values) < LEAST_LENGTH:
        table.refuse(key, f'"{key}" must point somewhere; {shown(table.values[key])} does not')
    return values


def choice(key: str, of: type[Enum]) -> Item:
    """One of an enum's words."""
    return one(key, lambda table, key: table.choice(key, of), lambda member: member.value)


# ---------------------------------------------------------------- of several keys


def travelled(table: Table) -> tuple[float, float, float]:
    """Forward, left and up in m, by the words for either way; zero where absent."""
    for key, opposite in zip(TRAVEL_KEYS, AGAINST, strict=True):
        table.not_both(key, (opposite,))
    pairs = zip(TRAVEL_KEYS, AGAINST, strict=True)
    forward, left, up = (
        (table.number(key) or 0.0) - (table.number(opposite) or 0.0) for key, opposite in pairs
    )
    return forward, left, up


def _read_when(table: Table) -> Values:
    table.not_both("frame", ("frames", "moment"))
    frames = table.pair("frames", "[first, last]")
    if frames is not None and frames[0] > frames[1]:
        table.refuse("frames", f"the last frame, {frames[1]:g}, comes before the first")
    if "moment" in table.values and not {"phase", "frames"} & set(table.values):
        table.refuse("moment", '"moment" is an instant of a "phase" or of "frames"; add one')
    frame = table.number("frame")
    if frame is not None:
        frames = (frame, frame)
    return {"when": When(table.phase("phase"), frames, table.choice("moment", Moment))}


def _write_when(record: Any) -> Values:
    when: When = record.when
    values: Values = {"phase": when.phase}
    if when.frames and when.frames[0] == when.frames[1] and not when.moment:
        values["frame"] = when.frames[0]
    else:
        values["frames"] = when.frames
    return values | {"moment": when.moment and when.moment.value}


def _read_touching(table: Table) -> Values:
    table.not_both("points", ("bones",))
    return {"touching": table.words("points") + table.words("bones")}


def _read_limits(table: Table) -> Values:
    table.not_both("fixed", ("at_least", "at_most"))
    lower, upper = (table.number(key, TURNS) for key in ("at_least", "at_most"))
    if lower is not None and upper is not None and lower > upper:
        table.refuse("at_most", f'"at_most", {upper:g}, is less than "at_least", {lower:g}')
    if "fixed" in table.values:
        lower = upper = table.number("fixed", TURNS)
    pair = (None if bound is None else math.radians(bound) for bound in (lower, upper))
    return dict(zip(("lower", "upper"), pair, strict=True))


def _write_limits(record: Any) -> Values:
    lower, upper = (b if b is None else degrees(b) for b in (record.lower, record.upper))
    if lower is not None and lower == upper:
        return {"fixed": lower}
    return {"at_least": lower, "at_most": upper}


WHEN = Item(("phase", "frames", "frame", "moment"), _read_when, _write_when)
BONE = word("bone")
SLACK = angle("slack", NOT_NEGATIVE)
BONES = one("bones", Table.words)
TOUCHING = Item(
    ("points", "bones"), _read_touching, lambda record: {"points": record.touching or None}
)
LIMIT_KEYS = ("at_least", "at_most", "fixed")
LIMITS = Item(LIMIT_KEYS, _read_limits, _write_limits)  # of an angle, degrees
