"""Keys of an action that has one on every frame, replaced by those that the artist asks for."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ...solver.data.reports.keys import KeysReport
from ..accessors import armature_data, current_scene, present
from ..armature import fcurves
from ..armature.incremental import Incremental, sample_incrementally
from ..armature.pose_basis import basis_under, with_ancestors
from ..armature.poses import Poses, frames_per_second, metres_per_unit
from ..controls.control_rig import ControlRig
from ..recipe.keys import KeyOptions
from .bezier_keys import splice_bezier
from .bone_channels import bone_channels
from .choose import chosen_keys
from .events import KeyEvents
from .pose_figure import PosedBones
from .posed_controls import PosedControls, posed_controls


@dataclass(frozen=True)
class KeyedAction:
    """A result's action and slot, of which the keys of some bones are chosen.

    bones: whose rotations it keys, the pelvis first. frames: (T,) those that have keys. take: the
    curves of the take that it was made from, None where there are none. rig: whose controls pose
    the bones, None where they have keys of their own.
    """

    action: bpy.types.Action
    slot: str | None
    bones: tuple[str, ...]
    frames: FloatArray
    take: fcurves.CurveHolder | None
    rig: ControlRig | None = None


def choose_keys(
    armature: bpy.types.Object,
    keyed: KeyedAction,
    options: KeyOptions,
    events: KeyEvents,
    showing: Callable[[], AbstractContextManager[object]] = nullcontext,
) -> Incremental[KeysReport]:
    """Replace an action's keys from its first frame to its last, in slices; the last one writes.

    Rotations of the bones, and the location that moves the first, get keys at frames of their own,
    the same for all channels of a bone. All other keys stay as they are, bit by bit. showing: lets
    the armature perform the action.
    """
    curves = fcurves.holder_in(keyed.action, keyed.slot)
    assert curves is not None  # the action was written for this slot
    posed: PosedBones | PosedControls
    if keyed.rig is None:
        posed = yield from _posed_bones(armature, keyed, curves, showing)
    else:
        posed = yield from posed_controls(keyed.rig, curves, keyed.frames)
    rate = frames_per_second(current_scene())
    chosen = yield from chosen_keys(posed, options, events, _taken(keyed), rate)
    for own, keys in zip(posed.channels, chosen.keys or (), strict=chosen.keys is not None):
        bone = present(armature.pose).bones[own.bone]
        for path, columns in own.paths:
            full = bone.path_from_id(path)
            splice_bezier(curves, full, keys.part(columns), events.extremes, own.bone)
    keyed.action.update_tag()
    return chosen.report


def _posed_bones(
    armature: bpy.types.Object,
    keyed: KeyedAction,
    curves: fcurves.CurveHolder,
    showing: Callable[[], AbstractContextManager[object]],
) -> Incremental[PosedBones]:
    """The bones' channels, and their poses."""
    poses = yield from sample_incrementally(armature, keyed.frames, showing)
    bases = _bases(armature, poses, keyed.bones)
    channels = bone_channels(armature, keyed.bones, bases, curves, keyed.frames)
    to_world = poses.object_to_world.copy()
    to_world[:, :3] *= metres_per_unit(current_scene())
    return PosedBones(armature, keyed.frames, tuple(channels), bases, to_world)


def _bases(
    armature: bpy.types.Object, poses: Poses, bones: tuple[str, ...]
) -> dict[str, FloatArray]:
    """Pose bases (T, 4, 4) of bones and their ancestors, parents first."""
    found = {}
    for name in with_ancestors(armature, bones):
        bone = armature_data(armature).bones[name]
        matrices = poses.matrices[:, poses.bones.index(name)]
        parent = poses.matrices[:, poses.bones.index(bone.parent.name)] if bone.parent else None
        found[name] = basis_under(bone, parent, matrices)
    return found


def _taken(keyed: KeyedAction) -> dict[str, FloatArray]:
    """Frames of the take's keys by bone, of those within the result's."""
    found: dict[str, list[FloatArray]] = {}
    for curve in keyed.take.fcurves if keyed.take is not None else ():
        bone = fcurves.bone_of(curve.data_path)
        at = fcurves.keys(curve)[:, 0]
        within = at[(at >= keyed.frames[0]) & (at <= keyed.frames[-1])]
        if bone is not None and len(within):
            found.setdefault(bone, []).append(within)
    return {bone: np.unique(np.concatenate(parts)) for bone, parts in found.items()}
