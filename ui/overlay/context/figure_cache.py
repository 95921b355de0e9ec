"""A cache of traced motions as figures in their armature's space."""

from typing import TypeVar

import bpy
import numpy as np

from ....bridge.accessors import armature_data
from ....solver.data.traces import Traces
from ...drawing.cache import ContentCache
from ..geometry.body_rotations import TracedFigure, body_turns
from .view_context import ShownMotion, ViewContext

B = TypeVar("B", bpy.types.Bone, bpy.types.PoseBone)


class FigureCache:
    """Traced figures by their motion."""

    def __init__(self) -> None:
        self._cache: ContentCache[TracedFigure | None] = ContentCache()

    def of(self, view: ViewContext, shown: ShownMotion | None) -> TracedFigure | None:
        """The figure of a motion; None without one, or if bones are not called so any more."""
        if shown is None:
            return None
        content = (shown.key, view.armature.name_full, view.metres)
        return self._cache.get("figure", content, lambda: figure_of(view, shown))

    def clear(self) -> None:
        self._cache.clear()


def figure_of(view: ViewContext, shown: ShownMotion) -> TracedFigure | None:
    """Not kept: takes milliseconds."""
    traces, bones = shown.traces, armature_data(view.armature).bones
    if not all(name in bones for name in traces.bones):
        return None
    parents = tuple(_parent(bones[name], traces) for name in traces.bones)
    if any(parent >= body for body, parent in enumerate(parents)):
        return None  # the bones have been joined in another order since
    rest = np.array([bones[name].head_local for name in traces.bones], float)
    back = np.array(shown.stood.inverted_safe())
    back[:3, :3] /= view.metres
    heads, tails = (p @ back[:3, :3].T + back[:3, 3] for p in (traces.heads, traces.tails))
    turns = body_turns(parents, rest, heads)
    return TracedFigure(traces.frames, traces.bones, parents, rest, heads, tails, turns)


def _parent(bone: bpy.types.Bone, traces: Traces) -> int:
    above = parent_of(bone, traces)
    return traces.bones.index(above.name) if above is not None else -1


def parent_of(bone: B, traces: Traces) -> B | None:
    """The nearest bone above that physics moves."""
    above: B | None = bone.parent
    while above is not None and above.name not in traces.bones:
        above = above.parent
    return above
