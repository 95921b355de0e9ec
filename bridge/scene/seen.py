"""What is seen of objects as frames pass, the scene being afterwards as the artist had it.

Rigid bodies have to be simulated before.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, nullcontext
from functools import partial
from typing import TypeVar

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ..accessors import current_scene
from ..action_slots import all_curves
from ..armature.incremental import Incremental, in_slices
from ..armature.poses import evaluated
from ..movable import movers

T = TypeVar("T")
Showing = Callable[[], AbstractContextManager[object]]


def seen_at(
    objects: Sequence[bpy.types.Object],
    frames: FloatArray,
    look: Callable[[bpy.types.Object], T],
) -> list[list[T]]:
    """What `look` finds of each object, as the dependency graph has it at frames (T,).

    The scene's frame, and what is hidden, are afterwards what they were.
    """
    scene, found = current_scene(), []
    with evaluated(objects):
        for frame in frames:
            whole = int(np.floor(frame))
            scene.frame_set(whole, subframe=frame - whole)
            graph = bpy.context.evaluated_depsgraph_get()
            found.append([look(each.evaluated_get(graph)) for each in objects])
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
    body, data = thing.rigid_body, thing.animation_data
    if body is None or body.type != "ACTIVE":
        return False
    action = None if data is None else data.action
    keyed = action is not None and any("rigid_body" in c.data_path for c in all_curves(action))
    return keyed or (body.enabled and not body.kinematic)


def _step(objects: Sequence[bpy.types.Object], frames: FloatArray) -> None:
    """From the frame before the first, as another one is shown between two slices."""
    seen_at(objects, np.array([frames[0] - 1.0, *frames]), lambda _: None)
