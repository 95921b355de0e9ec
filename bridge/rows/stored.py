"""Declarations of stored properties as data, so that they load without Blender."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from typing import Any


class PropertyType(Enum):
    """Blender's property types, by their functions in bpy.props."""

    BOOLEAN = "BoolProperty"
    BOOLEANS = "BoolVectorProperty"
    ENUM = "EnumProperty"
    NUMBER = "FloatProperty"
    OBJECT = "PointerProperty"
    VECTOR = "FloatVectorProperty"
    WHOLE = "IntProperty"


@dataclass(frozen=True)
class Stored:
    """A stored property: its type, and the options of its function in bpy.props."""

    type: PropertyType
    options: Mapping[str, Any]


Fields = Mapping[str, Stored]


def _declared(of: PropertyType, name: str, description: str, options: dict[str, Any]) -> Stored:
    return Stored(of, {"name": name, "description": description, **options})


def boolean(name: str, description: str = "", **options: Any) -> Stored:
    """A checkbox."""
    return _declared(PropertyType.BOOLEAN, name, description, options)


def booleans(name: str, description: str = "", **options: Any) -> Stored:
    """Three checkboxes, one an axis."""
    return _declared(PropertyType.BOOLEANS, name, description, {"size": 3, **options})


def choice(name: str, of: type[Enum], description: str = "", **options: Any) -> Stored:
    """One of an enum's members: their names are stored, their values are read."""
    items = [(each.name, str(each.value), "") for each in of]
    return _declared(PropertyType.ENUM, name, description, {"items": items, **options})


def number(name: str, description: str = "", **options: Any) -> Stored:
    """A number."""
    return _declared(PropertyType.NUMBER, name, description, options)


def frame(name: str, description: str = "") -> Stored:
    """A scene frame, which need not be whole."""
    return number(name, description, precision=1, step=100)


def whole(name: str, description: str = "", **options: Any) -> Stored:
    """A whole number."""
    return _declared(PropertyType.WHOLE, name, description, options)


def vector(name: str, description: str = "", **options: Any) -> Stored:
    """Three numbers."""
    return _declared(PropertyType.VECTOR, name, description, {"size": 3, **options})


def target(name: str, description: str = "") -> Stored:
    """An object of the scene."""
    return _declared(PropertyType.OBJECT, name, description, {})
