"""What may move or change its shape while frames pass; all else need not be looked at again."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import nullcontext
from functools import partial

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ..accessors import current_scene
from ..armature.incremental import Incremental, in_slices
from .bone_parts import bending_armature
from .seen import Showing, seen_at


def may_move(thing: bpy.types.Object) -> bool:
    """Whether anything could move an object: its keys, constraints or physics, or a parent's."""
    return any(_is_driven(each) for each in _with_parents(thing))


def may_deform(thing: bpy.types.Object) -> bool:
    """Whether anything could change an object's shape."""
    data = thing.data
    keys = getattr(data, "shape_keys", None)
    animated = any(each is not None and each.animation_data is not None for each in (data, keys))
    return animated or bool(len(thing.modifiers)) or thing.type == "META"


def movers(thing: bpy.types.Object) -> list[bpy.types.Object]:
    """An object, and what it hangs on or follows."""
    found = [thing]
    for each in found:  # which grows
        targets = (getattr(constraint, "target", None) for constraint in each.constraints)
        more = dict.fromkeys((each.parent, bending_armature(each), *targets))
        found += [other for other in more if other is not None and other not in found]
    return found


def simulate(
    objects: Sequence[bpy.types.Object], last: float, showing: Showing = nullcontext
) -> Incremental[None]:
    """Have Blender simulate the rigid bodies that move objects, up to a frame, so that any frame up
    to it may be looked at.

    It simulates only from one frame to the next, beginning with the cache's first; on a jump to
    frames that are not in the cache it leaves a body where it was. showing: as of `in_slices`.
    """
    world = current_scene().rigidbody_world
    if world is None or not world.enabled or world.point_cache.is_baked:
        return
    cache = world.point_cache
    if any(_is_simulated(mover) for thing in objects for mover in movers(thing)):
        frames = np.arange(cache.frame_start, min(np.ceil(last), cache.frame_end) + 1.0)
        yield from in_slices(frames, partial(_step, objects), showing)


def _is_simulated(thing: bpy.types.Object) -> bool:
    return thing.rigid_body is not None and thing.rigid_body.type == "ACTIVE"


def _step(objects: Sequence[bpy.types.Object], frames: FloatArray) -> None:
    """From the frame before the first, as another one is shown between two slices."""
    seen_at(objects, np.array([frames[0] - 1.0, *frames]), lambda _: None)


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
