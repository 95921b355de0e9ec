"""Action from an adapted performance; the recording's is left alone."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from contextlib import AbstractContextManager, nullcontext

import bpy
import numpy as np
from mathutils import Matrix, Vector

from ...solver.arrays import FloatArray
from ...solver.data.recording import PoseTrack
from ..accessors import armature_data, current_action, current_scene, mapped_strip, pose_of, present
from ..fake_users import guard
from . import fcurves
from .channels import channels, proper
from .incremental import Incremental, complete, sample_incrementally
from .played import scene_copy
from .pose_basis import carrier_of, pose_bases
from .poses import metres_per_unit
from .steady_joints import steady_bases

_ROTATION_CHANNELS = {"QUATERNION": "rotation_quaternion", "AXIS_ANGLE": "rotation_axis_angle"}
_EULER_CHANNEL = "rotation_euler"


def write_action(armature: bpy.types.Object, track: PoseTrack, *, name: str) -> bpy.types.Action:
    """Copy the armature's action, give the track's bones their new poses and assign the copy.

    Every bone of the track gets its rotation keyed at each of the track's frames in its own
    rotation mode, the first one (or, where that is connected to its parent, the nearest ancestor
    that can move) its location too; linear in between. What would move joints in the body above
    holds still (`steady_joints.py`). All other curves keep their shape, cut to the track's frames.
    The recording's action gets a fake user and is not changed otherwise.
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
    frames: FloatArray | None = None,
    showing: Callable[[], AbstractContextManager[object]] = nullcontext,
) -> Incremental[bpy.types.Action]:
    """Write, in slices, for a recording in that slot of an action, without assigning the copy.

    frames: the recording's, the track's without. showing: lets the armature perform it.
    """
    poses = yield from sample_incrementally(armature, track.frames, showing)
    told = track.frames if frames is None else frames
    steady = yield from steady_bases(armature, poses, track.bones, told, showing)
    made = yield from pose_bases(armature, poses, track, steady)
    action = scene_copy(armature, recorded, name)
    whole = False
    try:
        yield from _write_bases(armature, track, made, steady, fcurves.holder_in(action, slot))
        whole = True
    finally:
        if not whole:  # cancelled in between: half an action is of no use to anybody
            bpy.data.actions.remove(action)
    guard(recorded)
    return action


def _write_bases(
    armature: bpy.types.Object,
    track: PoseTrack,
    made: dict[str, FloatArray],
    steady: Iterable[str],
    curves: fcurves.CurveHolder | None,
) -> Incremental[None]:
    """Write the pose bases (T, 4, 4) by bone into curves, a bone a slice. steady: bones that hold
    joints."""
    assert curves is not None
    carrier = carrier_of(armature_data(armature).bones[track.bones[0]]).name
    posed = pose_of(armature).bones
    written = [(bone, rotation_channel(posed[bone])) for bone in track.bones]
    written.append((carrier, "location"))
    for bone in steady:
        held = steady_properties(armature, curves, track.bones, bone)
        written += [(bone, attribute) for attribute in held]
    for bone, attribute in written:
        _write_property(curves, posed[bone], attribute, track.frames, made[bone])
        yield None
    for curve in curves.fcurves:
        fcurves.crop(curve, float(track.frames[0]), float(track.frames[-1]))


def rotation_channel(bone: bpy.types.PoseBone) -> str:
    """The property that holds a bone's rotation in its mode."""
    return _ROTATION_CHANNELS.get(bone.rotation_mode, _EULER_CHANNEL)


def steady_properties(
    armature: bpy.types.Object, curves: fcurves.CurveHolder, bodies: tuple[str, ...], name: str
) -> list[str]:
    """Properties with keys of a bone that holds joints (`steady_joints.py`), of which these are to
    be replaced. bodies: the pelvis first; what turns them, and carries it, is the motion's."""
    rest, bone = armature_data(armature).bones, pose_of(armature).bones[name]
    wanted = ["scale"]
    if name not in bodies:
        wanted.append(rotation_channel(bone))
    if not rest[name].use_connect and name != carrier_of(rest[bodies[0]]).name:
        wanted.append("location")
    keyed = {curve.data_path for curve in curves.fcurves}
    return [each for each in wanted if bone.path_from_id(each) in keyed]


def property_values(
    bone: bpy.types.PoseBone, attribute: str, bases: FloatArray, near: FloatArray
) -> FloatArray:
    """(T, n) location, scale or rotation of bases (T, 4, 4). near: as of `channels`."""
    if attribute == "location":
        return np.asarray(bases[:, :3, 3])
    if attribute == "scale":
        return np.asarray(np.linalg.norm(bases[:, :3, :3], axis=1))
    return channels(proper(bases[:, :3, :3]), bone.rotation_mode, near)


def _write_property(
    curves: fcurves.CurveHolder,
    bone: bpy.types.PoseBone,
    attribute: str,
    frames: FloatArray,
    bases: FloatArray,
) -> None:
    if attribute == rotation_channel(bone):
        remove_other_rotations(curves, bone, attribute)
    path = bone.path_from_id(attribute)
    near = np.array(getattr(bone, attribute))
    for index in range(len(near)):
        curve = curves.fcurves.find(path, index=index)
        if curve is not None:
            near[index] = curve.evaluate(frames[0])
    values = property_values(bone, attribute, bases, near)
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
