"""Copies of stored settings, row by row; what is worked out and not stored is left out."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any
from zlib import crc32

import bpy

_LAST = ("met", "status")  # others, when they are set, forget these


def copy_settings(
    source: bpy.types.PropertyGroup, target: bpy.types.PropertyGroup, skip: Collection[str] = ()
) -> None:
    """Make everything stored in a group that of another of its class. skip: names left alone."""
    for name in sorted(_names(source, skip), key=lambda name: name in _LAST):
        _copy(source, target, source.bl_rna.properties[name])


def settings_digest(group: bpy.types.PropertyGroup, skip: Collection[str] = ()) -> str:
    """A number for everything that is stored in a group, and what its texts say; another where
    something differs. Of a data-block that it points to counts only whether there is one: which,
    `settings_targets` tells."""
    return str(crc32(repr(_stored(group, skip)).encode()))


def settings_targets(
    group: bpy.types.PropertyGroup, skip: Collection[str] = ()
) -> list[bpy.types.ID]:
    """The data-blocks that a group points to, texts aside, in an order that is always the same."""
    found: list[bpy.types.ID] = []
    for name in _names(group, skip):
        what, value = group.bl_rna.properties[name], getattr(group, name)
        if what.type == "COLLECTION":
            found += [each for row in value for each in settings_targets(row, skip)]
        elif _is_group(group, what):
            found += settings_targets(value, skip)
        elif what.type == "POINTER" and not isinstance(value, bpy.types.Text | None):
            found.append(value)
    return found


def _copy(source: Any, target: Any, what: bpy.types.Property) -> None:
    name = what.identifier
    if what.type == "COLLECTION":
        rows, copies = getattr(source, name), getattr(target, name)
        while len(copies) < len(rows):
            copies.add()
        for index in reversed(range(len(rows), len(copies))):
            copies.remove(index)  # an override keeps those of the linked file
        for row, copied in zip(rows, copies, strict=False):
            copy_settings(row, copied)
    elif _is_group(source, what):
        copy_settings(getattr(source, name), getattr(target, name))
    elif source.is_property_set(name):
        setattr(target, name, getattr(source, name))
    elif target.is_property_set(name):
        target.property_unset(name)


def _is_group(owner: Any, what: bpy.types.Property) -> bool:
    """Whether a property is a group of its own, and no pointer to a data-block."""
    if what.type != "POINTER":
        return False
    return isinstance(getattr(owner, what.identifier), bpy.types.PropertyGroup)


def _names(group: bpy.types.PropertyGroup, skip: Collection[str]) -> list[str]:
    """Names of what is stored in a group."""
    computed = getattr(group, "COMPUTED", ())
    names = (each.identifier for each in group.bl_rna.properties)
    return [name for name in names if name not in {"rna_type", *computed, *skip}]


def _stored(group: Any, skip: Collection[str]) -> list[tuple[str, object]]:
    found: list[tuple[str, object]] = []
    for name in _names(group, skip):
        what = group.bl_rna.properties[name]
        value: Any = getattr(group, name) if what.type in {"COLLECTION", "POINTER"} else None
        if what.type == "COLLECTION":
            found.append((name, [_stored(row, skip) for row in value]))
        elif _is_group(group, what):
            found.append((name, _stored(value, skip)))
        elif isinstance(value, bpy.types.Text):
            found.append((name, value.as_string()))
        elif what.type == "POINTER":
            found.append((name, value is not None))  # whatever the artist calls it
        elif group.is_property_set(name):
            many = getattr(what, "is_array", False)
            value = tuple(getattr(group, name)) if many else getattr(group, name)
            if value != (tuple(what.default_array) if many else what.default):
                found.append((name, value))  # else it is as if nobody had touched it
    return found


def resized(rows: Any, count: int) -> list[Any]:
    """Makes a list that many rows long, the old ones first: these rows.

    An override cannot drop rows of the linked file: those left over are switched off.
    """
    while len(rows) < count:
        rows.add()
    for i in reversed(range(count, len(rows))):
        rows.remove(i)
    for row in rows[count:]:
        row.name = ""
        if hasattr(row, "used"):
            row.used = False
    return list(rows[:count])
