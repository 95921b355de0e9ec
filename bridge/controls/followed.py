"""What acts in a rig at a frame: switches between kinds of controls may be thrown on the way."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext

import bpy
import numpy as np

from ...solver.arrays import BoolArray, FloatArray
from ..accessors import current_scene, pose_of
from ..armature.incremental import Incremental, in_slices
from ..armature.poses import evaluated
from .driven import constraints_of

LOOKS = 3  # frames at which a rig is looked at, beside one for each state of its switches
FAINT = 1e-3  # influence, below which a switch is off


def telling_frames(
    armature: bpy.types.Object,
    frames: FloatArray,
    showing: Callable[[], AbstractContextManager[object]] = nullcontext,
) -> Incremental[FloatArray]:
    """Frames (L,) of those (T,) that show all that acts in a rig at any: some that are spread
    evenly, and the middle one of each state of its switches."""
    states = yield from acting(armature, frames, showing)
    at = np.linspace(0, len(frames) - 1, LOOKS).round().astype(int).tolist()
    for state in np.unique(states, axis=0):
        rows = np.flatnonzero((states == state).all(axis=1))
        at.append(int(rows[len(rows) // 2]))
    return np.asarray(frames[np.unique(at)])


def acting(
    armature: bpy.types.Object,
    frames: FloatArray,
    showing: Callable[[], AbstractContextManager[object]] = nullcontext,
) -> Incremental[BoolArray]:
    """(T, N) which constraints of an armature act at frames (T,)."""
    influences = Influences(armature)

    def look(part: FloatArray) -> FloatArray:
        return np.stack([influences.at(float(frame)) for frame in part])

    parts = yield from in_slices(frames, look, showing)
    return np.asarray(np.concatenate(parts) > FAINT)


class Influences:
    """How much each constraint of an armature acts."""

    def __init__(self, armature: bpy.types.Object) -> None:
        self._armature = armature
        self._indices = [
            (bone.name, list(bone.constraints).index(each))
            for bone, each in constraints_of(armature)
        ]

    def at(self, frame: float) -> FloatArray:
        """(N,) as drivers and keys have it at a frame; the scene's is what it was."""
        with evaluated([self._armature]):
            whole = int(np.floor(frame))
            current_scene().frame_set(whole, subframe=frame - whole)
            return self.now()

    def now(self) -> FloatArray:
        """(N,) at the scene's frame."""
        posed = self._armature.evaluated_get(bpy.context.evaluated_depsgraph_get())
        bones = pose_of(posed).bones
        return np.array([bones[name].constraints[index].influence for name, index in self._indices])
