"""What bodies follow, through constraints and parents: whether inverse kinematics poses them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from contextlib import AbstractContextManager, nullcontext

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ..accessors import current_scene, pose_of
from ..armature.incremental import Incremental, in_slices
from ..armature.poses import evaluated
from .driven import chain_of, constraints_of

_FAINT = 1e-3  # influence, below which a switch is off


def in_chains(
    armature: bpy.types.Object,
    bodies: Iterable[str],
    frames: FloatArray,
    showing: Callable[[], AbstractContextManager[object]] = nullcontext,
) -> Incremental[list[str]]:
    """Those of the bodies that inverse kinematics poses at any of the frames (T,)."""
    every = list(constraints_of(armature))
    if not any(chain_of(*each) for each in every):
        return []
    indices = [(bone.name, list(bone.constraints).index(each)) for bone, each in every]

    def look(part: FloatArray) -> FloatArray:
        return _influences(armature, indices, part)

    parts = yield from in_slices(frames, look, showing)
    acts = np.max(parts, axis=0) > _FAINT
    acting = [each for each, on in zip(every, acts, strict=True) if on]
    chained = {name for each in acting for name in chain_of(*each)}
    above = _followed(armature, acting)
    return [body for body in bodies if chained & _all_above(body, above)]


def _influences(
    armature: bpy.types.Object, indices: list[tuple[str, int]], frames: FloatArray
) -> FloatArray:
    """The largest influence of each constraint, by bone and index, as drivers and keys have it."""
    found = np.zeros(len(indices))
    with evaluated([armature]):
        for frame in frames:
            current_scene().frame_set(int(frame))
            posed = armature.evaluated_get(bpy.context.evaluated_depsgraph_get())
            bones = pose_of(posed).bones
            now = [bones[name].constraints[index].influence for name, index in indices]
            found = np.maximum(found, now)
    return found


def _followed(
    armature: bpy.types.Object,
    acting: Iterable[tuple[bpy.types.PoseBone, bpy.types.Constraint]],
) -> dict[str, set[str]]:
    """Bones that each bone follows: its parent, and what its constraints aim at."""
    bones = pose_of(armature).bones
    found = {b.name: {b.parent.name} if b.parent is not None else set[str]() for b in bones}
    for bone, constraint in acting:
        for aim in getattr(constraint, "targets", [constraint]):
            if getattr(aim, "target", None) == armature:
                found[bone.name] |= {getattr(aim, "subtarget", "")} & found.keys()
    return found


def _all_above(bone: str, above: dict[str, set[str]]) -> set[str]:
    """The bone and all that it follows, whatever is between."""
    found, left = {bone}, [bone]
    while left:
        new = above[left.pop()] - found
        found |= new
        left.extend(new)
    return found
