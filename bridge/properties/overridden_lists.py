"""Which rows of an overridden armature's lists come from the linked file: the first ones.

Blender keeps an override's changes of these rows' values, but neither that one is gone or renamed
nor that its bones are others: it would add them anew when the file is opened. Where the library has
got rows since, an opened override has its own ones anywhere among these, and twice what both found.
"""

from __future__ import annotations

from typing import Any

import bpy

from ..accessors import attached
from ..rows.copying import copy_settings
from .settings import HangtimeSettings
from .stances import stance_contacts

_FOUND = ("contacts", "stances", "findings", "parts")  # by an analysis, each name once
_ASKED = ("constraints", "body_changes", "surfaces")


def linked_count(armature: bpy.types.Object, rows: str) -> int:
    """How many of a list, the first ones, are linked; rows: the name of the settings' property."""
    override = armature.override_library
    if override is None or override.reference is None:
        return 0
    return len(getattr(attached(override.reference), rows))


def settle_lists(override: bpy.types.Object, library: bpy.types.Object) -> None:
    """Has an override's lists begin with the library's rows, and each row that both found once, as
    the override has it. library: what it overrides."""
    settings, theirs = attached(override), attached(library)
    chosen = _name_at(settings.contacts, settings.active_contact)
    for name in (*_FOUND, *_ASKED):
        rows, count = getattr(settings, name), len(getattr(theirs, name))
        if not 0 < count < len(rows):
            continue
        linked = _put_linked_first(rows)
        if name in _FOUND:
            _join_namesakes(rows, linked)
    if _name_at(settings.contacts, settings.active_contact) != chosen:
        settings.active_contact = settings.contacts.find(chosen)
    _let_go(settings, theirs)


def _name_at(rows: Any, index: int) -> str:
    return str(rows[index].name) if 0 <= index < len(rows) else ""


def _put_linked_first(rows: Any) -> int:
    """How many they are. Nothing tells which rows are linked, but that Blender refuses to move
    these; one is added for the time, as no row is refused to stay the last."""
    rows.add()
    place = 0
    for _ in range(len(rows) - 1):
        try:
            rows.move(place, len(rows) - 1)
        except TypeError:
            place += 1
    rows.remove(place)
    return place


def _join_namesakes(rows: Any, linked: int) -> None:
    """Puts the override's rows into those of the same names, of which the first are linked."""
    names = [row.name for row in rows[:linked]]
    for index in reversed(range(linked, len(rows))):
        if rows[index].name in names:
            copy_settings(rows[index], rows[names.index(rows[index].name)])
            rows.remove(index)


def _let_go(settings: HangtimeSettings, theirs: HangtimeSettings) -> None:
    """Of contacts and stances that only another analysis in the library found."""
    if settings.analysed_contacts in ("", theirs.analysed_contacts):
        return
    names = str(settings.analysed_contacts).splitlines()
    for row in settings.contacts[: len(theirs.contacts)]:
        if row.name not in names:
            row.let_go()
    for stance in settings.stances[: len(theirs.stances)]:
        if not stance_contacts(settings, stance.name):
            stance.let_go()
