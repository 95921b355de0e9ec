"""Traced motions as figures in their armature's space, kept for as long as they are the same."""

from __future__ import annotations

import bpy
import numpy as np

from ....solver.data.traces import Traces
from ..geometry.body_rotations import Figure, body_turns
from .cache import Cache
from .view_context import Seen, Shown


class Figures:
    """Figures by their motion."""

    def __init__(self) -> None:
        self._cache: Cache[Figure | None] = Cache()

    def of(self, seen: Seen, shown: Shown | None) -> Figure | None:
        """The figure of a motion; None without one, or if bones are not called so any more."""
        if shown is None:
            return None
        content = (shown.key, seen.armature.name_full, seen.metres)
        return self._cache.get("figure", content, lambda: figure_of(seen, shown))

    def clear(self) -> None:
        self._cache.clear()


def figure_of(seen: Seen, shown: Shown) -> Figure | None:
    """Not kept: takes milliseconds."""
    traces, bones = shown.traces, seen.armature.data.bones
    if not all(name in bones for name in traces.bones):
        return None
    parents = tuple(_parent(bones[name], traces) for name in traces.bones)
    if any(parent >= body for body, parent in enumerate(parents)):
        return None  # the bones have been joined in another order since
    rest = np.array([bones[name].head_local for name in traces.bones])
    back = np.array(shown.stood.inverted_safe())
    back[:3, :3] /= seen.metres
    heads, tails = (p @ back[:3, :3].T + back[:3, 3] for p in (traces.heads, traces.tails))
    turns = body_turns(parents, rest, heads)
    return Figure(traces.frames, traces.bones, parents, rest, heads, tails, turns)


def _parent(bone: bpy.types.Bone, traces: Traces) -> int:
    above = parent_of(bone, traces)
    return traces.bones.index(above.name) if above is not None else -1


def parent_of(bone: bpy.types.Bone | bpy.types.PoseBone, traces: Traces) -> bpy.types.Bone | None:
    """The nearest bone above that physics moves."""
    above = bone.parent
    while above is not None and above.name not in traces.bones:
        above = above.parent
    return above
