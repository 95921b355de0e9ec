"""Action from an adapted performance; the recording's is left alone."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext

import bpy
import numpy as np
from mathutils import Matrix, Vector

from ...solver.arrays import FloatArray
from ...solver.data.recording import PoseTrack
from ..accessors import armature_data, current_action, current_scene, mapped_strip, pose_of, present
from . import fcurves
from .channels import channels, proper
from .incremental import Incremental, complete, sample_incrementally
from .played import scene_copy
from .pose_basis import carrier_of, pose_bases
from .poses import metres_per_unit

_ROTATION_CHANNELS = {"QUATERNION": "rotation_quaternion", "AXIS_ANGLE": "rotation_axis_angle"}
_EULER_CHANNEL = "rotation_euler"


def write_action(armature: bpy.types.Object, track: PoseTrack, *, name: str) -> bpy.types.Action:
    """Copy the armature's action, give the track's bones their new poses and assign the copy.

    Every bone of the track gets its rotation keyed at each of the track's frames in its own
    rotation mode, the first one (or, where that is connected to its parent, the nearest ancestor
    that can move) its location too; linear in between. All other curves keep their shape, cut to
    the track's frames. The recording's action gets a fake user and is not changed otherwise.
    Raises KeyError where the armature lacks a bone of the track.
    """
    recorded, slot = present(current_action(armature)), fcurves.slot_identifier(armature)
    action = complete(write_incrementally(armature, track, recorded, slot, name=name))
    fcurves.assign(armature, action, slot)
    return action


def write_incrementally(
    armature: bpy.types.Object,
    track: PoseTrack,
    recorded: bpy.types.Action,
    slot: str | None,
    *,
    name: str,
    showing: Callable[[], AbstractContextManager[object]] = nullcontext,
) -> Incremental[bpy.types.Action]:
    """Write, in slices, for a recording in that slot of an action, without assigning the copy.

    showing: lets the armature perform the recording.
    """
    poses = yield from sample_incrementally(armature, track.frames, showing)
    made = yield from pose_bases(armature, poses, track)
    action = scene_copy(armature, recorded, name)
    whole = False
    try:
        yield from _write_bases(armature, track, made, fcurves.holder_in(action, slot))
        whole = True
    finally:
        if not whole:  # cancelled in between: half an action is of no use to anybody
            bpy.data.actions.remove(action)
    recorded.use_fake_user = True
    return action


def _write_bases(
    armature: bpy.types.Object,
    track: PoseTrack,
    made: dict[str, FloatArray],
    curves: fcurves.CurveHolder | None,
) -> Incremental[None]:
    """Write the pose bases (T, 4, 4) by bone into curves, a bone a slice."""
    assert curves is not None
    carrier = carrier_of(armature_data(armature).bones[track.bones[0]]).name
    for bone in track.bones:
        _write_rotation(curves, pose_of(armature).bones[bone], track.frames, made[bone])
        yield
    path = pose_of(armature).bones[carrier].path_from_id("location")
    fcurves.write_channels(curves, path, track.frames, made[carrier][:, :3, 3], carrier)
    for curve in curves.fcurves:
        fcurves.crop(curve, float(track.frames[0]), float(track.frames[-1]))


def rotation_channel(bone: bpy.types.PoseBone) -> str:
    """The property that holds a bone's rotation in its mode."""
    return _ROTATION_CHANNELS.get(bone.rotation_mode, _EULER_CHANNEL)


def _write_rotation(
    curves: fcurves.CurveHolder, bone: bpy.types.PoseBone, frames: FloatArray, basis: FloatArray
) -> None:
    used = rotation_channel(bone)
    remove_other_rotations(curves, bone, used)
    path = bone.path_from_id(used)
    near = np.array(getattr(bone, used))
    for index in range(len(near)):
        curve = curves.fcurves.find(path, index=index)
        if curve is not None:
            near[index] = curve.evaluate(frames[0])
    values = channels(proper(basis[:, :3, :3]), bone.rotation_mode, near)
    fcurves.write_channels(curves, path, frames, values, bone.name)


def remove_other_rotations(
    curves: fcurves.CurveHolder, bone: bpy.types.PoseBone, used: str
) -> None:
    """Remove the curves of a bone's rotation in other modes than the used property's."""
    for channel in (*_ROTATION_CHANNELS.values(), _EULER_CHANNEL):
        if channel != used:
            remove(curves, bone.path_from_id(channel))


def remove(curves: fcurves.CurveHolder, path: str) -> None:
    """Remove the curves of a property."""
    for curve in [c for c in curves.fcurves if c.data_path == path]:
        curves.fcurves.remove(curve)


def side_by_side(
    armature: bpy.types.Object,
    recording: bpy.types.Action,
    adapted: bpy.types.Action,
    *,
    offset: tuple[float, float, float] = (1.5, 0.0, 0.0),
) -> bpy.types.Object:
    """Show both: `adapted` on the armature, `recording` on a copy of it moved by `offset`.

    offset: world, m. The copy is called "<name> recording", shares the armature's bones and is
    linked where the armature is; constraints and drivers that look at the armature itself look at
    the copy itself. Returns the copy.
    """
    slot = fcurves.slot_identifier(armature)
    fcurves.assign(armature, adapted, slot)
    copy = armature.copy()
    copy.name = f"{armature.name} recording"
    for collection in armature.users_collection:
        collection.objects.link(copy)
    played = mapped_strip(armature, recording) is not None  # and the copy has that strip too
    fcurves.assign(copy, None if played else recording, slot)
    units = Vector(offset) / metres_per_unit(current_scene())
    # A delta, because the location itself may be animated; it counts in the parent's space.
    to_parent = _parent_space(armature).inverted()
    copy.delta_location = copy.delta_location + to_parent @ units
    return copy


def _parent_space(armature: bpy.types.Object) -> Matrix:
    """Rotation and scale of the space in which the object's own location counts."""
    if armature.parent is None:
        return Matrix.Identity(3)
    return (armature.parent.matrix_world @ armature.matrix_parent_inverse).to_3x3()
