"""What is seen of objects as frames pass, the scene being afterwards as the artist had it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from typing import TypeVar

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ..accessors import current_scene
from ..armature.poses import evaluated

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
