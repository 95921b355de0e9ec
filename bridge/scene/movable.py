"""What may move or change its shape while frames pass; all else need not be looked at again."""

from __future__ import annotations

from collections.abc import Iterator

import bpy


def may_move(thing: bpy.types.Object) -> bool:
    """Whether anything could move an object: its keys, constraints or physics, or a parent's."""
    return any(_is_driven(each) for each in _with_parents(thing))


def may_deform(thing: bpy.types.Object) -> bool:
    """Whether anything could change an object's shape."""
    data = thing.data
    keys = getattr(data, "shape_keys", None)
    animated = any(each is not None and each.animation_data is not None for each in (data, keys))
    return animated or bool(len(thing.modifiers)) or thing.type == "META"


def _is_driven(thing: bpy.types.Object) -> bool:
    return (
        thing.animation_data is not None
        or bool(len(thing.constraints))
        or thing.rigid_body is not None
        or thing.parent_type not in ("OBJECT", "")  # a bone's or a vertex's movement
    )


def _with_parents(thing: bpy.types.Object) -> Iterator[bpy.types.Object]:
    each: bpy.types.Object | None = thing
    while each is not None:
        yield each
        each = each.parent
