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


def bending_armature(thing: bpy.types.Object) -> bpy.types.Object | None:
    """The armature whose bones carry an object's mesh, by a modifier or as its parent."""
    for modifier in thing.modifiers:
        if isinstance(modifier, bpy.types.ArmatureModifier) and modifier.object is not None:
            return modifier.object
    bent = thing.type == "MESH" and thing.parent_type == "ARMATURE"
    return thing.parent if bent else None


def movers(thing: bpy.types.Object) -> list[bpy.types.Object]:
    """An object, and what it hangs on or follows."""
    found = [thing]
    for each in found:  # which grows
        targets = (getattr(constraint, "target", None) for constraint in each.constraints)
        more = dict.fromkeys((each.parent, bending_armature(each), *targets))
        found += [other for other in more if other is not None and other not in found]
    return found


def _is_driven(thing: bpy.types.Object) -> bool:
    data = thing.animation_data  # which stays when all of it was removed
    return (
        (data is not None and bool(data.action or len(data.drivers) or len(data.nla_tracks)))
        or bool(len(thing.constraints))
        or thing.rigid_body is not None
        or thing.parent_type not in ("OBJECT", "")  # a bone's or a vertex's movement
    )


def _with_parents(thing: bpy.types.Object) -> Iterator[bpy.types.Object]:
    each: bpy.types.Object | None = thing
    while each is not None:
        yield each
        each = each.parent
