"""What rows of the lists share: how Blender keeps their properties, their bones and their state."""

from __future__ import annotations

from functools import partial
from typing import Any

import bpy

from . import bone_keys
from .choices import Met
from .stored import PropertyType, Stored, boolean, choice, text

HIDDEN = {"HIDDEN"}
OVERRIDABLE = {"LIBRARY_OVERRIDABLE"}
OVERRIDABLE_LIST = {"LIBRARY_OVERRIDABLE", "USE_INSERTION"}


# Blender evaluates a class's annotations apart from this module's names, so that a lambda among
# them would not find any: callbacks are functions.


def forget_status(row: Any, _context: bpy.types.Context) -> None:
    """What the last solve said of a row holds no longer."""
    if row.met != Met.UNKNOWN.name:
        row.met = Met.UNKNOWN.name
    if row.status:
        row.status = ""


def declared(stored: Stored, **shared: Any) -> Any:
    """Blender's property of a declaration, with the options that it shares with others."""
    options = {**stored.options, **shared}
    if stored.type is PropertyType.OBJECT:
        options.setdefault("type", bpy.types.Object)
    return getattr(bpy.props, stored.type.value)(**options)


chosen = partial(declared, override=OVERRIDABLE)  # by the artist
asked = partial(chosen, update=forget_status)  # of the next solve
hidden = partial(chosen, options=HIDDEN)  # kept for the artist

# What every row has.
NAME = text("Name", "Your name for it, by which it is reported")
MET = choice("Met", Met)
STATUS = text()  # a line to be drawn
USED = boolean("Use", "Whether this counts", default=True)


class HangtimeBoneMark(bpy.types.PropertyGroup):
    """Of an armature's bone: the key by which rows find it after it was renamed."""

    key: declared(text(), options=HIDDEN)


def _armature_of(row: HangtimeBone) -> bpy.types.Object:
    assert isinstance(row.id_data, bpy.types.Object)
    return row.id_data


def _get_bone(row: HangtimeBone) -> str:
    return bone_keys.current_name(_armature_of(row), row.key, row.called)


def _set_bone(row: HangtimeBone, name: str) -> None:
    row.called = name
    row.key = bone_keys.remember(_armature_of(row), name)


class HangtimeBone(bpy.types.PropertyGroup):
    """A bone of the armature; `name` follows when the artist renames it (see bone_keys.py)."""

    COMPUTED = ("name",)  # from what else is stored

    key: hidden(text())
    called: hidden(text())
    name: chosen(text("Bone", "A bone of the armature", get=_get_bone, set=_set_bone))


CLASSES = (HangtimeBoneMark, HangtimeBone)
