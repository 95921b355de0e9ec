"""Pose basis: wanted poses in armature space to the channels of each bone."""

from __future__ import annotations

from collections.abc import Mapping

import bpy
import numpy as np
from mathutils import Matrix

from ...solver.arrays import FloatArray
from ...solver.data.recording import PoseTrack
from ..accessors import armature_data, current_scene
from .channels import proper
from .incremental import Incremental
from .poses import Poses, metres_per_unit


def pose_bases(
    armature: bpy.types.Object,
    poses: Poses,
    track: PoseTrack,
    steady: Mapping[str, FloatArray],
) -> Incremental[dict[str, FloatArray]]:
    """Basis matrices (T, 4, 4) by bone, for the track's bones and all their ancestors; a bone a
    slice.

    Walks down from the roots: a bone of the track turns to the wanted rotation, any other keeps
    what it had relative to its parent, which may have moved. steady: bases (T, 4, 4) that bones
    have instead of those in the poses, the turns of the track's apart.
    """
    pelvis = track.bones[0]
    carrier = carrier_of(armature_data(armature).bones[pelvis]).name
    shift = _wanted_head(poses, track) - poses.matrices[:, poses.bones.index(pelvis), :3, 3]
    wanted = dict(zip(track.bones, _wanted_rotations(poses, track), strict=True))
    result: dict[str, FloatArray] = {}
    new: dict[str, FloatArray] = {}
    for name in with_ancestors(armature, track.bones):
        bone = armature_data(armature).bones[name]
        old = poses.matrices[:, poses.bones.index(name)]
        old_parent = poses.matrices[:, poses.bones.index(bone.parent.name)] if bone.parent else None
        parent = new[bone.parent.name] if bone.parent else None
        basis = steady[name].copy() if name in steady else basis_under(bone, old_parent, old)
        target = old.copy()
        target[:, :3, :3] = wanted.get(name, old[:, :3, :3])
        target[:, :3, 3] += shift
        if name == carrier:
            basis[:, :3, 3] = basis_under(bone, parent, target)[:, :3, 3]
        if name in wanted:
            stretch = np.swapaxes(proper(basis[:, :3, :3]), 1, 2) @ basis[:, :3, :3]
            basis[:, :3, :3] = proper(basis_under(bone, parent, target)[:, :3, :3]) @ stretch
        result[name] = basis
        new[name] = place(bone, parent, basis)
        yield None
    return result


def _wanted_rotations(poses: Poses, track: PoseTrack) -> FloatArray:
    """The track's rotations (len(bones), T, 3, 3) in the armature's space."""
    turned = np.swapaxes(proper(poses.object_to_world[:, :3, :3]), 1, 2)
    return np.moveaxis(turned[:, None] @ track.rotations, 1, 0)


def _wanted_head(poses: Poses, track: PoseTrack) -> FloatArray:
    """The pelvis's head (T, 3) in the armature's space and units."""
    units = track.root_head / metres_per_unit(current_scene())
    world = poses.object_to_world
    return np.linalg.solve(world[:, :3, :3], (units - world[:, :3, 3])[..., None])[..., 0]


def carrier_of(bone: bpy.types.Bone) -> bpy.types.Bone:
    """Bone whose location moves `bone`: Blender ignores the location of connected bones."""
    while bone.use_connect and bone.parent is not None:
        bone = bone.parent
    return bone


def with_ancestors(armature: bpy.types.Object, bones: tuple[str, ...]) -> list[str]:
    """These bones and all their ancestors, parents first."""
    rest = [armature_data(armature).bones[name] for name in bones]
    found = {b.name: b for bone in rest for b in (bone, *bone.parent_recursive)}
    return sorted(found, key=lambda name: len(found[name].parent_recursive))


def place(bone: bpy.types.Bone, parent: FloatArray | None, basis: FloatArray) -> FloatArray:
    """Poses (T, 4, 4), in the armature's space, of a bone with these channels under `parent`."""
    return _convert(bone, parent, basis, invert=False)


def basis_under(bone: bpy.types.Bone, parent: FloatArray | None, pose: FloatArray) -> FloatArray:
    """The channels (T, 4, 4) that bring a bone under `parent` to these poses."""
    return _convert(bone, parent, pose, invert=True)


def _convert(
    bone: bpy.types.Bone, parent: FloatArray | None, matrices: FloatArray, *, invert: bool
) -> FloatArray:
    rest = np.array(bone.matrix_local, float)
    above = bone.parent.matrix_local if bone.parent is not None else None
    if _inherits_all(bone):
        frame = rest
        if parent is not None:
            frame = parent @ np.linalg.solve(np.array(above), rest)
        return np.linalg.solve(frame, matrices) if invert else frame @ matrices
    # The rules for bones that inherit only in part are many: Blender knows them.
    parents = (
        [{}] * len(matrices)
        if parent is None
        else [{"parent_matrix": Matrix(p), "parent_matrix_local": above} for p in parent]
    )
    return np.array(
        [
            bone.convert_local_to_pose(Matrix(m), bone.matrix_local, invert=invert, **p)
            for m, p in zip(matrices, parents, strict=True)
        ]
    )


def _inherits_all(bone: bpy.types.Bone) -> bool:
    """True where a parent passes rotation, location and scale on in full."""
    if not bone.use_local_location:
        return False
    return bone.parent is None or (bone.use_inherit_rotation and bone.inherit_scale == "FULL")
