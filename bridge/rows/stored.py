"""Declarations of stored properties as data, so that they load without Blender."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from typing import Any

DIGITS = 4  # of lengths: Blender counts those before the point too


class PropertyType(Enum):
    """Blender's property types, by their functions in bpy.props."""

    BOOLEAN = "BoolProperty"
    BOOLEANS = "BoolVectorProperty"
    ENUM = "EnumProperty"
    NUMBER = "FloatProperty"
    OBJECT = "PointerProperty"
    TEXT = "StringProperty"
    VECTOR = "FloatVectorProperty"
    WHOLE = "IntProperty"


@dataclass(frozen=True)
class Stored:
    """A stored property: its type, and the options of its function in bpy.props."""

    type: PropertyType
    options: Mapping[str, Any]


Fields = Mapping[str, Stored]


def _declared(of: PropertyType, name: str, description: str, options: dict[str, Any]) -> Stored:
    texts = {"name": name, "description": description}
    return Stored(of, {key: text for key, text in texts.items() if text} | options)


def boolean(name: str = "", description: str = "", **options: Any) -> Stored:
    """A checkbox."""
    return _declared(PropertyType.BOOLEAN, name, description, options)


def booleans(name: str, description: str = "") -> Stored:
    """Three checkboxes, one an axis, all on at first."""
    options = {"size": 3, "default": (True, True, True)}
    return _declared(PropertyType.BOOLEANS, name, description, options)


def choice(name: str, of: type[Enum], description: str = "", **options: Any) -> Stored:
    """One of an enum's members: their names are stored, their values are read."""
    items = [(each.name, str(each.value), "") for each in of]
    return _declared(PropertyType.ENUM, name, description, {"items": items, **options})


def number(name: str = "", description: str = "", **options: Any) -> Stored:
    """A number."""
    return _declared(PropertyType.NUMBER, name, description, options)


def angle(name: str, description: str = "", **options: Any) -> Stored:
    """An angle, rad; degrees for the artist."""
    return number(name, description, subtype="ANGLE", **options)


def frame(name: str, description: str = "") -> Stored:
    """A scene frame, which need not be whole."""
    return number(name, description, precision=1, step=100)


def whole(name: str = "", description: str = "", **options: Any) -> Stored:
    """A whole number."""
    return _declared(PropertyType.WHOLE, name, description, options)


def vector(name: str = "", description: str = "", **options: Any) -> Stored:
    """Three numbers."""
    return _declared(PropertyType.VECTOR, name, description, {"size": 3, **options})


def position(name: str, description: str = "", **options: Any) -> Stored:
    """A place, or the way to it."""
    shared = {"subtype": "TRANSLATION", "unit": "LENGTH", "precision": DIGITS}
    return vector(name, description, **shared, **options)


def text(name: str = "", description: str = "", **options: Any) -> Stored:
    """A line of text."""
    return _declared(PropertyType.TEXT, name, description, options)


def target(name: str = "", description: str = "", **options: Any) -> Stored:
    """A data-block; without a `type`, an object of the scene."""
    return _declared(PropertyType.OBJECT, name, description, options)


OFFSET = vector(
    "Offset",
    "From the bone's head, in the bone's axes and the armature's own units, which its object's "
    "scale makes the world's",
    precision=DIGITS,
)
