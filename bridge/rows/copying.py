"""Copies of stored settings, row by row; what is worked out and not stored is left out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any
from zlib import crc32

import bpy

OUTCOMES = ("met", "status")  # of a solve; other values, when they are set, forget these
_UNSET = object()  # what nobody has set

HeldSettings = dict[str, Any]
"""What a group stores, apart from it, by name: of a group within it the same, of rows a list of
these, of a data-block a `_Pointer`, and values."""


@dataclass(frozen=True)
class _Pointer:
    """To a data-block, by its number in this session, for an undo puts another in its place; 0 for
    none."""

    uid: int

    @property
    def target(self) -> bpy.types.ID | None:
        """None, too, where it is gone."""
        kinds = (bpy.data.objects, bpy.data.actions, bpy.data.collections, bpy.data.texts)
        every = (each for kind in kinds for each in kind) if self.uid else ()
        return next((each for each in every if each.session_uid == self.uid), None)


def copy_settings(
    source: bpy.types.PropertyGroup, target: bpy.types.PropertyGroup, skip: Sequence[str] = ()
) -> None:
    """Make everything stored in a group that of another of its class. skip: names left alone, of
    rows too."""
    put_settings(held_settings(source, skip), target)


def held_settings(group: Any, skip: Sequence[str] = ()) -> HeldSettings:
    """Everything that is stored in a group, to be put into one later. skip: names left out, of rows
    too."""
    held: HeldSettings = {}
    for name in sorted(_names(group, skip), key=lambda name: name in OUTCOMES):
        what, value = group.bl_rna.properties[name], getattr(group, name)
        if what.type == "COLLECTION":
            held[name] = [held_settings(row, skip) for row in value]
        elif _is_group(group, what):
            held[name] = held_settings(value, skip)
        elif what.type == "POINTER":
            held[name] = _Pointer(value.session_uid if value is not None else 0)
        elif not group.is_property_set(name):
            held[name] = _UNSET
        else:
            held[name] = _plain(group, name)
    return held


def put_settings(held: HeldSettings, target: Any) -> None:
    """Make what was held that of a group of its class. What is not another value is not set, so
    that no outcome is forgotten for it."""
    for name, value in held.items():
        if isinstance(value, list):
            for row, kept in zip(_rows_for(value, target, name), value, strict=True):
                put_settings(kept, row)
        elif isinstance(value, dict):
            put_settings(value, getattr(target, name))
        elif isinstance(value, _Pointer):
            if getattr(target, name) != value.target:
                setattr(target, name, value.target)
        elif value is _UNSET:
            target.property_unset(name)
        elif not (target.is_property_set(name) and _plain(target, name) == value):
            setattr(target, name, value)


def _rows_for(held: list[HeldSettings], target: Any, name: str) -> list[Any]:
    """A group's rows to put these into: by their names, or by place where rows store none."""
    rows, kind = getattr(target, name), target.bl_rna.properties[name].fixed_type
    row_class = bpy.types.PropertyGroup.bl_rna_get_subclass_py(kind.identifier)
    if "name" not in getattr(row_class, "COMPUTED", ()):
        named = (row["name"] for row in held)
        return rows_named(rows, ["" if each is _UNSET else str(each) for each in named])
    if len(rows) != len(held):
        rows.clear()  # but for linked ones
    while len(rows) < len(held):
        rows.add()
    return list(rows)[: len(held)]


def _plain(group: Any, name: str) -> object:
    """A stored value; of a vector the tuple."""
    value = getattr(group, name)
    many = getattr(group.bl_rna.properties[name], "is_array", False)
    return tuple(value) if many else value


def settings_digest(
    group: bpy.types.PropertyGroup, skip: Sequence[str] = (), *, off: bool = True
) -> tuple[str, list[bpy.types.ID]]:
    """A number for everything that is stored in a group, and what its texts say, another where
    something differs; and the data-blocks that it points to, texts aside, in an order that is
    always the same, of which the number tells only whether they are there.

    off: whether rows that are switched off count.
    """
    targets: list[bpy.types.ID] = []
    stored = _stored(group, tuple(skip), targets, off=off)
    return str(crc32(repr(stored).encode())), targets


def _is_group(owner: Any, what: bpy.types.Property) -> bool:
    """Whether a property is a group of its own, and no pointer to a data-block."""
    if what.type != "POINTER":
        return False
    return isinstance(getattr(owner, what.identifier), bpy.types.PropertyGroup)


def _names(group: bpy.types.PropertyGroup, skip: Sequence[str]) -> tuple[str, ...]:
    """Names of what is stored in a group."""
    # classes are hashable, whatever the stubs say
    return _names_in(type(group), tuple(skip))  # type: ignore[arg-type]


@cache
def _names_in(kind: type[bpy.types.PropertyGroup], skip: tuple[str, ...]) -> tuple[str, ...]:
    """In a class, which looks are for again and again: each has many groups."""
    left_out = {"rna_type", *getattr(kind, "COMPUTED", ()), *skip}
    names = (each.identifier for each in kind.bl_rna.properties)
    return tuple(name for name in names if name not in left_out)


def _counted(rows: Any, *, off: bool) -> list[Any]:
    return [row for row in rows if off or getattr(row, "used", True)]


def _stored(
    group: Any, skip: tuple[str, ...], targets: list[bpy.types.ID], *, off: bool
) -> list[tuple[str, object]]:
    """What is stored in a group. targets: to which the data-blocks are added that it points to."""
    found: list[tuple[str, object]] = []
    for name in _names(group, skip):
        what = group.bl_rna.properties[name]
        value: Any = getattr(group, name) if what.type in {"COLLECTION", "POINTER"} else None
        if what.type == "COLLECTION":
            rows = _counted(value, off=off)
            found.append((name, [_stored(row, skip, targets, off=off) for row in rows]))
        elif isinstance(value, bpy.types.PropertyGroup):
            found.append((name, _stored(value, skip, targets, off=off)))
        elif isinstance(value, bpy.types.Text):
            found.append((name, value.as_string()))
        elif what.type == "POINTER":
            found.append((name, value is not None))  # whatever the artist calls it
            targets += [] if value is None else [value]
        elif group.is_property_set(name):
            many, value = getattr(what, "is_array", False), _plain(group, name)
            if value != (tuple(what.default_array) if many else what.default):
                found.append((name, value))  # else it is as if nobody had touched it
    return found


def rows_named(rows: Any, names: Sequence[str]) -> list[Any]:
    """Makes a list's rows those of these names, in order: these rows, new where names are others.

    An override can neither drop nor rename rows of the linked file, which would come back when the
    file is opened: of these the namesakes are taken, wherever they are, and others are let go.
    """
    if [row.name for row in rows] == list(names):
        return list(rows)
    rows.clear()  # but for the linked ones
    linked, places = list(range(len(rows))), []
    for name in names:
        place = next((i for i in linked if rows[i].name == name), None)
        if place is None:
            place = len(rows)
            rows.add().name = name
        else:
            linked.remove(place)
        places.append(place)
    for i in linked:
        _let_go(rows[i])
    return [rows[place] for place in places]


def _let_go(row: Any) -> None:
    if hasattr(row, "let_go"):
        row.let_go()
    elif hasattr(row, "used"):
        row.used = False
