"""What rows of the lists of constraints and of body changes share: their bones and their state."""

from __future__ import annotations

from collections.abc import Iterable
from enum import Enum
from typing import Any

import bpy

from . import bone_keys
from .choices import Met

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


ASKED: dict[str, object] = {"override": OVERRIDABLE, "update": forget_status}


def items(kinds: Iterable[Enum]) -> list[tuple[str, str, str]]:
    return [(kind.name, kind.value, "") for kind in kinds]


class HangtimeBoneMark(bpy.types.PropertyGroup):
    """Of an armature's bone: the key by which rows find it after it was renamed."""

    key: bpy.props.StringProperty(options=HIDDEN)


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

    key: bpy.props.StringProperty(options=HIDDEN, override=OVERRIDABLE)
    called: bpy.props.StringProperty(options=HIDDEN, override=OVERRIDABLE)
    name: bpy.props.StringProperty(
        name="Bone",
        description="A bone of the armature",
        get=_get_bone,
        set=_set_bone,
        override=OVERRIDABLE,
    )


CLASSES = (HangtimeBoneMark, HangtimeBone)
