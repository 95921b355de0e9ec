"""Recording from an armature and its action."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, nullcontext

import bpy
import numpy as np
from mathutils import Vector

from ...solver.arrays import FloatArray, IntArray
from ...solver.data.faults import BadScale, NoArmature, NoBones, NonFiniteKey
from ...solver.data.recording import Bone, Recording
from ..accessors import armature_data, current_action, current_scene, pose_of, present
from ..libraries import lost_character, lost_file
from ..properties.of_actions.known_contacts import known_at
from . import fcurves
from .channels import proper
from .incremental import Incremental, in_slices
from .played import leaders_of, require_unblended, require_unstarred, strip_time, why_no_action
from .poses import Poses, followed_bone, frames_per_second, metres_per_unit, sample

_SAME_SCALE = 1e-4  # relative; float32 and chains of parents leave about 1e-6
_EPSILON = 1e-4  # frames


def read_recording(
    armature: bpy.types.Object | None,
    *,
    first: float | None = None,
    last: float | None = None,
    beyond: float = 0.0,
) -> Recording:
    """Sample the evaluated pose of every bone at every whole scene frame in [first, last].

    The range defaults to the action's, and one that reaches beyond its keys ends with them where
    nothing moves the armature there. beyond: s, on both sides of a stated range that are read too
    as far as the action goes. World space, m, s; the rotations carry no scale. The scene is left as
    it was. The recording is called what the action is called.

    Raises NoArmature, LibraryMissing, NoBones, NoAction (also for an action without curves or
    without a slot for this armature), UnreadStrips, StripsOff, BlendedAction, NonFiniteKey,
    BadScale.
    """
    frames = whole_frames(armature, first, last, beyond)
    return record(present(armature), frames)


def whole_frames(
    armature: bpy.types.Object | None, first: float | None, last: float | None, beyond: float = 0.0
) -> FloatArray:
    """Whole frames of a recording (T,), at least one. beyond: as in `read_recording`.

    Raises as `read_recording`, but for what poses show.
    """
    armature, curves = _require_animated(armature)
    require_unstarred(armature)
    require_unblended(armature)
    for curve in curves:
        _require_finite(armature, curve)
    action = present(current_action(armature))
    keyed = there = _played(armature, [curve.range() for curve in curves])
    if action.use_frame_range:
        there = _played(armature, [action.frame_range])
        keyed = min(keyed[0], there[0]), max(keyed[1], there[1])
    start = there[0] if first is None else float(np.ceil(first - _EPSILON))
    end = max(start, there[1] if last is None else float(np.floor(last + _EPSILON)))
    if start <= keyed[1] and keyed[0] <= end and not _goes_on(armature, curves):
        start, end = max(start, keyed[0]), min(end, keyed[1])
    reach = np.floor(beyond * frames_per_second(current_scene()))
    before = start if first is None else max(start - reach, there[0])
    after = end if last is None else min(end + reach, there[1])
    return np.arange(min(before, start), max(after, end) + 1.0) + 0.0  # no frame is called -0


def _played(armature: bpy.types.Object, spans: Sequence[Vector]) -> tuple[float, float]:
    """First and last whole frame of spans of its action's frames, as the scene plays them."""
    first, last = min(span[0] for span in spans), max(span[1] for span in spans)
    time = strip_time(armature, present(current_action(armature)))
    if time is not None:
        first, last = time.clipped(first, last)
    return float(np.ceil(first - _EPSILON)), float(np.floor(last + _EPSILON))


def _goes_on(armature: bpy.types.Object, curves: list[bpy.types.FCurve]) -> bool:
    """Whether an armature may move beyond its keys: as its curves go on there, or as drivers or
    other objects, such as a parent that moves, take it along."""
    extended = any(
        curve.extrapolation == "LINEAR" or any(not each.mute for each in curve.modifiers)
        for curve in curves
    )
    data = armature.animation_data
    return extended or (data is not None and len(data.drivers) > 0) or _is_taken_along(armature)


def _is_taken_along(armature: bpy.types.Object) -> bool:
    """Whether a parent that is animated, or a constraint to another object, moves it."""
    parent = armature.parent
    while parent is not None:
        if parent.animation_data is not None or len(parent.constraints) > 0:
            return True
        parent = parent.parent
    owners = (armature, *pose_of(armature).bones)
    constraints = [each for owner in owners for each in owner.constraints if not each.mute]
    followed = (thing for each in constraints for thing, _ in leaders_of(each))
    return any(thing is not None and thing != armature for thing in followed)


def last_keyed(armature: bpy.types.Object) -> float:
    """Last whole frame at which the action that an armature shows has a key, as the scene plays it.

    Raises as `whole_frames`.
    """
    armature, curves = _require_animated(armature)
    spans = np.array([curve.range() for curve in curves])
    time = strip_time(armature, present(current_action(armature)))
    last = spans.max() if time is None else time.clipped(spans.min(), spans.max())[1]
    return float(np.floor(last + _EPSILON))


def record(armature: bpy.types.Object, frames: FloatArray) -> Recording:
    """Record an armature that has an action at any frames (T,), whole or not.

    Raises NonFiniteKey, BadScale.
    """
    return recording_of(armature, frames, sample(armature, frames))


def record_incrementally(
    armature: bpy.types.Object,
    frames: FloatArray,
    showing: Callable[[], AbstractContextManager[object]] = nullcontext,
) -> Incremental[Recording]:
    """The same, a few frames a slice. showing: as of `in_slices`. Raises as `record`."""
    count = len(armature_data(armature).bones)
    heads, rotations = np.empty((len(frames), count, 3)), np.empty((len(frames), count, 3, 3))

    def look(rows: IntArray) -> Recording | None:
        poses = sample(armature, frames[rows])
        heads[rows], rotations[rows] = _placed(armature, frames[rows], poses)
        return None if rows[0] else _recording(armature, frames, poses, heads, rotations)

    recording, *_ = yield from in_slices(np.arange(len(frames)), look, showing)
    return present(recording)  # which later slices have filled


def recording_of(armature: bpy.types.Object, frames: FloatArray, poses: Poses) -> Recording:
    """Convert poses sampled at frames (T,) to a Recording. Raises NonFiniteKey, BadScale."""
    return _recording(armature, frames, poses, *_placed(armature, frames, poses))


def _placed(
    armature: bpy.types.Object, frames: FloatArray, poses: Poses
) -> tuple[FloatArray, FloatArray]:
    """Heads (T, B, 3) m and rotations (T, B, 3, 3) in the world, of poses at frames (T,)."""
    _require_uniform_scale(armature, poses.object_to_world)
    world = poses.object_to_world[:, None] @ poses.matrices
    _require_finite_poses(poses, frames, world)
    return world[..., :3, 3] * metres_per_unit(current_scene()), proper(world[..., :3, :3])


def _recording(
    armature: bpy.types.Object,
    frames: FloatArray,
    poses: Poses,
    heads: FloatArray,
    rotations: FloatArray,
) -> Recording:
    """Of heads and rotations (T, B, ...) at frames (T,). poses: of the first of these, at least."""
    action = present(current_action(armature))
    return Recording(
        name=action.name,
        bones=rest_bones(armature, poses),
        frames=frames,
        times=(frames - frames[0]) / frames_per_second(current_scene()),
        heads=heads,
        rotations=rotations,
        known=known_at(action, (frames[0], frames[-1]), strip_time(armature, action)),
    )


def rest_bones(armature: bpy.types.Object, poses: Poses) -> tuple[Bone, ...]:
    """The rest skeleton where the object stands at the first frame."""
    world, metres = poses.object_to_world[0], metres_per_unit(current_scene())

    def place(point: Vector) -> FloatArray:
        return np.asarray((world[:3, :3] @ np.array(point) + world[:3, 3]) * metres)

    def bone(name: str, parent: int) -> Bone:
        rest = armature_data(armature).bones[name]
        rotation = proper(world[:3, :3] @ np.array(rest.matrix_local, float)[:3, :3])
        head, tail = place(rest.head_local), place(rest.tail_local)
        return Bone(name, parent, head, tail, rotation, followed_bone(armature, name))

    return tuple(map(bone, poses.bones, poses.parents))


def named_bones(armature: bpy.types.Object) -> list[Bone]:
    """The bones at rest, parents first; in the armature's own space and units."""
    bones = sorted(armature_data(armature).bones, key=lambda bone: len(bone.parent_recursive))
    index = {bone.name: i for i, bone in enumerate(bones)}
    return [
        Bone(
            bone.name,
            index[bone.parent.name] if bone.parent else -1,
            np.array(bone.head_local, float),
            np.array(bone.tail_local, float),
            np.array(bone.matrix_local.to_3x3(), float),
            followed_bone(armature, bone.name),
        )
        for bone in bones
    ]


def _require_animated(
    armature: bpy.types.Object | None,
) -> tuple[bpy.types.Object, list[bpy.types.FCurve]]:
    """The armature and its action's curves."""
    if armature is None or armature.type != "ARMATURE":
        raise NoArmature(armature.name if armature is not None else None)
    lost = lost_character(armature) or lost_file(current_action(armature))
    if lost is not None:
        raise lost
    if len(armature_data(armature).bones) == 0:
        raise NoBones(armature.name)
    curves = fcurves.curves_of(armature)
    if not curves:
        raise why_no_action(armature)
    return armature, curves


def _require_finite(armature: bpy.types.Object, curve: bpy.types.FCurve) -> None:
    keys = fcurves.column(curve, "co")
    # One number tells of all keys, as NaN is below nothing: a rig has three million of them in a
    # thousand frames. Blender's own interface turns infinity into the largest float32.
    largest = np.finfo(np.float32).max
    if np.abs(keys).max(initial=0.0) < largest:
        return
    bad = ~(np.abs(keys) < largest).all(axis=1)
    bone = fcurves.bone_of(curve.data_path) or armature.name
    raise NonFiniteKey(bone, float(keys[bad][0, 0]))


def _require_finite_poses(poses: Poses, frames: FloatArray, world: FloatArray) -> None:
    """Handles, modifiers and drivers can spoil a pose as well as keys."""
    bad = np.argwhere(~np.isfinite(world).all(axis=(2, 3)))
    if len(bad) > 0:
        frame, bone = bad[0]
        raise NonFiniteKey(poses.bones[bone], float(frames[frame]))


def _require_uniform_scale(armature: bpy.types.Object, object_to_world: FloatArray) -> None:
    """One positive scale along all axes at every frame, the parents' included."""
    linear = object_to_world[:, :3, :3]
    gram = np.swapaxes(linear, 1, 2) @ linear
    square = np.trace(gram, axis1=1, axis2=2) / 3.0
    uneven = np.abs(gram - square[:, None, None] * np.eye(3)).max((1, 2)) > _SAME_SCALE * square
    bad = uneven | (np.linalg.det(linear) <= 0.0)
    if bad.any():
        x, y, z = np.linalg.norm(linear[bad][0], axis=0)
        own = armature.scale.x, armature.scale.y, armature.scale.z
        alone = armature.parent is None and np.allclose(np.abs(own), (x, y, z), rtol=1e-4)
        raise BadScale(armature.name, own if alone else (float(x), float(y), float(z)))
