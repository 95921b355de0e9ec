"""Poses of the bones that carry a figure from their curves alone, where nothing else moves them.

Evaluating the scene at a thousand frames takes seconds; what follows a jump needs but the pelvis.
"""

from __future__ import annotations

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ..accessors import armature_data, pose_of, present, take_strips
from ..armature import fcurves
from ..armature.channels import rotations_of
from ..armature.pose_basis import place, with_ancestors
from ..armature.poses import Poses
from ..armature.write import rotation_channel


def plain_poses(
    armature: bpy.types.Object,
    curves: fcurves.CurveHolder,
    bones: tuple[str, ...],
    frames: FloatArray,
) -> Poses | None:
    """Poses of bones and their ancestors at frames (T,), as these curves animate them; None where
    more than these curves moves them or the object."""
    rest, names = armature_data(armature).bones, with_ancestors(armature, bones)
    if not _plain(armature, curves, names):
        return None
    above = [rest[name].parent for name in names]
    parents = tuple(-1 if each is None else names.index(each.name) for each in above)
    posed: list[FloatArray] = []
    for name, parent in zip(names, parents, strict=True):
        basis = _bases(pose_of(armature).bones[name], curves, frames)
        posed.append(place(rest[name], posed[parent] if parent >= 0 else None, basis))
    world = np.tile(np.array(armature.matrix_world, float), (len(frames), 1, 1))
    return Poses(tuple(names), parents, world, np.stack(posed, axis=1))


def _plain(armature: bpy.types.Object, curves: fcurves.CurveHolder, bones: list[str]) -> bool:
    data = present(armature.animation_data)
    every = sum(len(track.strips) for track in data.nla_tracks)
    others = data.use_nla and every > len(take_strips(armature))
    whole = data.action_blend_type == "REPLACE" and data.action_influence == 1.0
    moved = armature.parent is not None or len(armature.constraints) > 0
    moved |= any(not curve.data_path.startswith("pose.") for curve in curves.fcurves)
    held = any(len(pose_of(armature).bones[name].constraints) for name in bones)
    return whole and not (others or moved or held or len(data.drivers))


def _bases(bone: bpy.types.PoseBone, curves: fcurves.CurveHolder, frames: FloatArray) -> FloatArray:
    """(T, 4, 4) bases as Blender makes them of a bone's channels."""
    location, rotation, scale = (
        _values(bone, curves, name, frames)
        for name in ("location", rotation_channel(bone), "scale")
    )
    bases = np.tile(np.eye(4), (len(frames), 1, 1))
    bases[:, :3, :3] = rotations_of(rotation, bone.rotation_mode) * scale[:, None]
    bases[:, :3, 3] = location
    return bases


def _values(
    bone: bpy.types.PoseBone, curves: fcurves.CurveHolder, name: str, frames: FloatArray
) -> FloatArray:
    """(T, n) values of a bone's property; as it is where no curve animates it."""
    values = np.tile(np.array(getattr(bone, name), dtype=float), (len(frames), 1))
    path = bone.path_from_id(name)
    for index in range(values.shape[1]):
        curve = curves.fcurves.find(path, index=index)
        if curve is not None and not curve.mute:
            values[:, index] = fcurves.values_at(curve, frames)
    return values
