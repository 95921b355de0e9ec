"""A plain armature that performs takes as another one is evaluated: what goes into files.

No constraint, driver, parent or control is left, so that every format holds it. The scene's own
armature is not changed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Matrix

from ...solver.arrays import FloatArray
from ..accessors import armature_data, pose_of, present
from ..armature import fcurves
from ..armature.channels import channels, proper
from .shapes import write_shapes
from .skeleton import Skeleton

SCALE_NOISE = 2e-5  # of a scale that is 1: in single precision poses and rest poses are off by half
_LEAST = 1e-6  # of a scale: what hangs on a bone is told by what undoes it


@dataclass(frozen=True)
class BakedTake:
    """Poses (T, B, 4, 4) of a skeleton's bones, from the bone to the object, and values (T, K) of
    shape keys, at frames from `first` on."""

    name: str
    first: int
    poses: FloatArray
    shapes: FloatArray

    @property
    def last(self) -> int:
        """The last frame."""
        return self.first + len(self.poses) - 1


def bake(
    name: str, skeleton: Skeleton, placed: FloatArray, takes: Sequence[BakedTake]
) -> bpy.types.Object:
    """A new armature in the scene, with a track of the same name for each take, one above the
    other. placed (4, 4): its object to the world."""
    rig = _build(name, skeleton)
    rig.matrix_world = Matrix(placed.tolist())
    data = rig.animation_data_create()
    for take in takes:
        action, curves = fcurves.new_action(rig, take.name, rig.name)
        _write(rig, curves, skeleton, take)
        track = data.nla_tracks.new()
        strip = track.strips.new(take.name, take.first, action)
        if hasattr(action, "slots"):
            strip.action_slot = action.slots[0]
        strip.action_frame_start, strip.action_frame_end = take.first, take.last
        strip.frame_start, strip.frame_end = take.first, max(take.last, take.first + 1)
        strip.extrapolation = "NOTHING"  # beside it bones are at rest, and so files tell that
        track.name = strip.name = take.name
    return rig


def _build(name: str, skeleton: Skeleton) -> bpy.types.Object:
    data = bpy.data.armatures.new(name)
    rig = bpy.data.objects.new(name, data)
    present(present(bpy.context.scene).collection).objects.link(rig)
    present(bpy.context.view_layer).objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    made = [armature_data(rig).edit_bones.new(bone) for bone in skeleton.names]
    for i, bone in enumerate(made):
        bone.tail = (0.0, skeleton.lengths[i], 0.0)
        bone.matrix = Matrix(skeleton.rest[i])
        bone.use_deform = skeleton.deforms[i]
        if skeleton.parents[i] >= 0:
            bone.parent = made[skeleton.parents[i]]
    bpy.ops.object.mode_set(mode="OBJECT")
    return rig


def _write(
    rig: bpy.types.Object, curves: fcurves.CurveHolder, skeleton: Skeleton, take: BakedTake
) -> None:
    frames = np.arange(take.first, take.last + 1.0)
    rests = [np.array(armature_data(rig).bones[name].matrix_local) for name in skeleton.names]
    poses = _with_size(take.poses)
    held: list[FloatArray] = []  # (T, 4, 4) each: what the rig has of them
    for i, name in enumerate(skeleton.names):
        above, frame = skeleton.parents[i], rests[i]
        if above >= 0:
            frame = held[above] @ np.linalg.solve(rests[above], rests[i])
        basis = np.linalg.solve(frame, poses[:, i])
        place, turns = basis[:, :3, 3], proper(basis[:, :3, :3])
        sizes = np.linalg.norm(basis[:, :3, :3], axis=1)
        held.append(frame @ _basis(place, turns, sizes))
        bone = pose_of(rig).bones[name]
        bone.rotation_mode = "QUATERNION"
        written = {"location": place, "rotation_quaternion": channels(turns, "QUATERNION")}
        if np.abs(sizes - 1.0).max() > SCALE_NOISE:
            written["scale"] = sizes
        for channel, values in written.items():
            path = bone.path_from_id(channel)
            fcurves.write_channels(curves, path, frames, values, name)
    write_shapes(rig, curves, frames, take.shapes)


def _with_size(poses: FloatArray) -> FloatArray:
    """The same poses (T, B, 4, 4), where something is hidden by a scale of 0 with the least one, so
    that it stays out of sight."""
    found, axes = poses.copy(), poses[..., :3, :3]
    flat = np.linalg.svd(axes, compute_uv=False)[..., -1] < _LEAST
    u, sizes, vt = np.linalg.svd(axes[flat])
    found[flat, :3, :3] = u * np.maximum(sizes, _LEAST)[:, None] @ vt
    return found


def _basis(place: FloatArray, turns: FloatArray, sizes: FloatArray) -> FloatArray:
    """(T, 4, 4) of what a bone can have. A pose may have shear besides, where a bone does not
    inherit its parent's sizes in full, as files know no other way; places are kept of it."""
    found = np.tile(np.eye(4), (len(place), 1, 1))
    found[:, :3, :3], found[:, :3, 3] = turns * sizes[:, None], place
    return found
