"""Action of a loop: one cycle, a key on every frame, which Blender repeats without a seam."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ...solver.data.faults import NoRootBone
from ...solver.data.recording import PoseTrack
from ..accessors import armature_data, current_scene, pose_of, present
from ..armature import fcurves
from ..armature.actions import recorded_action, show, showing_action
from ..armature.channels import channels, proper
from ..armature.incremental import Incremental, sample_incrementally
from ..armature.played import scene_copy
from ..armature.pose_basis import carrier_of, pose_bases, with_ancestors
from ..armature.poses import Poses, metres_per_unit
from ..armature.write import remove, remove_other_rotations, rotation_channel
from ..keys.bezier_keys import splice_bezier
from ..properties.settings import settings_of
from ..rows.choices import LoopRoot
from ..takes.takes import derive, free_name, root_of
from ..takes.write_result import forget_copied
from .cyclic_keys import cyclic_keys

_TRANSFORMS = ("location", "rotation_", "scale", "delta_")


@dataclass(frozen=True)
class Loop:
    """One solved cycle, and the bone that carries its travel instead of the pelvis, if any does.

    track: its last pose is its first, further on. travels: whether the travel stays in the action.
    """

    track: PoseTrack
    root: bpy.types.Bone | None
    travels: bool

    @staticmethod
    def of(armature: bpy.types.Object, track: PoseTrack, root: LoopRoot) -> Loop:
        """Raises NoRootBone."""
        bone = root_bone(armature, track.bones[0]) if root is LoopRoot.ROOT_BONE else None
        return Loop(track, bone, travels=root is not LoopRoot.IN_PLACE)

    @property
    def travel(self) -> FloatArray:
        """(3,) m that a cycle covers, level, world."""
        head = self.track.root_head
        return np.asarray((head[-1] - head[0]) * [1.0, 1.0, 0.0])

    @property
    def of_the_body(self) -> PoseTrack:
        """The track without what the pelvis does not carry."""
        if self.travels and self.root is None:
            return self.track
        steady = np.linspace(0.0, 1.0, len(self.track.frames))[:, None] * self.travel
        return replace(self.track, root_head=self.track.root_head - steady)


def root_bone(armature: bpy.types.Object, pelvis: str) -> bpy.types.Bone:
    """The topmost bone above the pelvis, which moves all of the figure. Raises NoRootBone."""
    bone = armature_data(armature).bones[pelvis]
    if carrier_of(bone).parent is None:
        raise NoRootBone(armature.name, pelvis)
    top: bpy.types.Bone = bone.parent_recursive[-1]
    return top


def write_loop(
    armature: bpy.types.Object,
    loop: Loop,
    recorded: bpy.types.Action,
    slot: str | None,
    *,
    name: str,
) -> Incremental[bpy.types.Action]:
    """Write a loop as a copy of the recording's action, in slices; it is not assigned.

    What carries the body without being of it holds still as in the cycle's first frame. Other
    channels keep their shape within the cycle, and repeat; bones among them, such as fingers, give
    up evenly what they end away from their start.
    """
    showing = partial(showing_action, armature, recorded)
    frames = loop.track.frames
    first = yield from sample_incrementally(armature, frames[:1], showing)
    bases = yield from pose_bases(armature, _held(first, len(frames)), loop.of_the_body)
    action = scene_copy(armature, recorded, name)
    forget_copied(action)
    whole = False
    try:
        curves = fcurves.holder_in(action, slot)
        assert curves is not None
        _settle_others(armature, curves, loop)
        for bone in loop.track.bones:
            _write_rotation(curves, pose_of(armature).bones[bone], frames, bases[bone])
            yield
        carrier = carrier_of(armature_data(armature).bones[loop.track.bones[0]]).name
        goes_on = loop.travels and loop.root is None
        places = bases[carrier][:, :3, 3]
        _write(curves, pose_of(armature).bones[carrier], "location", frames, places, goes_on)
        if loop.root is not None:
            _write_root(armature, curves, loop.root, loop, first)
        for curve in fcurves.all_curves(action):
            _repeat(curve)
        action.use_frame_range = action.use_cyclic = True
        action.frame_start, action.frame_end = frames[[0, -1]].tolist()
        whole = True
    finally:
        if not whole:  # cancelled in between: half an action is of no use to anybody
            bpy.data.actions.remove(action)
    recorded.use_fake_user = True
    return action


def write_loop_incrementally(
    armature: bpy.types.Object, loop: Loop
) -> Incremental[bpy.types.Action]:
    """Write a loop as a new action, which is assigned and knows its recording.

    Before the last slice the armature is as it was.
    """
    original, slot = present(recorded_action(armature)), fcurves.slot_identifier(armature)
    name = free_name(root_of(original).name, "loop")
    action = yield from write_loop(armature, loop, original, slot, name=name)
    derive(action, original, armature)
    show(armature, action, slot)
    settings_of(armature).adapted = action
    return action


def _held(first: Poses, count: int) -> Poses:
    """The first pose for as many frames."""
    return replace(
        first,
        object_to_world=np.repeat(first.object_to_world, count, axis=0),
        matrices=np.repeat(first.matrices, count, axis=0),
    )


def _settle_others(armature: bpy.types.Object, curves: fcurves.CurveHolder, loop: Loop) -> None:
    """Hold the object, and bones that carry some of the body without being of it, as at the cycle's
    first frame; cut all else, and close what other bones do."""
    first, last = (float(loop.track.frames[k]) for k in (0, -1))
    carriers = set(with_ancestors(armature, loop.track.bones)) - set(loop.track.bones)
    held = tuple(pose_of(armature).bones[name].path_from_id() for name in carriers)
    for curve in list(curves.fcurves):
        if not len(curve.keyframe_points):
            continue
        if curve.data_path.startswith(_TRANSFORMS) or _is_of(curve, held):
            values = np.array([curve.evaluate(first)])
            for modifier in list(curve.modifiers):
                curve.modifiers.remove(modifier)
            like = fcurves.table(curve)
            fcurves.put(curve, fcurves.linear_keys(like, np.array([first]), values))
        else:
            fcurves.crop(curve, first, last)
            if curve.data_path.startswith("pose.bones"):
                _close(curve, first, last)


def _close(curve: bpy.types.FCurve, first: float, last: float) -> None:
    """Let a curve end where it begins, by an even slope on top of what it does."""
    slope = (curve.evaluate(last) - curve.evaluate(first)) / (last - first)
    keys = fcurves.table(curve)
    for name in ("co", "handle_left", "handle_right"):
        keys[name][:, 1] -= slope * (keys[name][:, 0] - first)
    fcurves.put(curve, keys)


def _is_of(curve: bpy.types.FCurve, paths: tuple[str, ...]) -> bool:
    return any(curve.data_path.startswith(f"{path}.") for path in paths)


def _write_rotation(
    curves: fcurves.CurveHolder, bone: bpy.types.PoseBone, frames: FloatArray, basis: FloatArray
) -> None:
    used = rotation_channel(bone)
    remove_other_rotations(curves, bone, used)
    near = np.array(getattr(bone, used))
    values = channels(proper(basis[:, :3, :3]), bone.rotation_mode, near)
    _write(curves, bone, used, frames, values, goes_on=False)


def _write(
    curves: fcurves.CurveHolder,
    bone: bpy.types.PoseBone,
    channel: str,
    frames: FloatArray,
    values: FloatArray,
    goes_on: bool,
) -> None:
    """Make keys of values (T, n) the channel's only ones. goes_on: with each repetition."""
    path = bone.path_from_id(channel)
    remove(curves, path)
    if not goes_on:
        values = np.concatenate([values[:-1], values[:1]])
    splice_bezier(curves, path, cyclic_keys(frames, values), np.empty(0), bone.name)
    if goes_on:
        for curve in (c for c in curves.fcurves if c.data_path == path):
            _repeat(curve, goes_on=True)


def _write_root(
    armature: bpy.types.Object,
    curves: fcurves.CurveHolder,
    root: bpy.types.Bone,
    loop: Loop,
    first: Poses,
) -> None:
    """Let the root bone travel, from where the first frame has it."""
    frames = loop.track.frames
    there = first.matrices[0, first.bones.index(root.name)]
    to_bone = first.object_to_world[0, :3, :3]
    if root.use_local_location:
        to_bone = to_bone @ np.array(root.matrix_local, float)[:3, :3]
    rest = np.linalg.solve(np.array(root.matrix_local, float), there)[:3, 3]
    if not root.use_local_location:
        rest = there[:3, 3] - np.array(root.matrix_local, float)[:3, 3]
    along = np.linalg.solve(to_bone, loop.travel / metres_per_unit(current_scene()))
    values = rest + np.linspace(0.0, 1.0, len(frames))[:, None] * along
    _write(curves, pose_of(armature).bones[root.name], "location", frames, values, goes_on=True)


def _repeat(curve: bpy.types.FCurve, *, goes_on: bool = False) -> None:
    """Let a curve repeat before and after its keys; one that has modifiers stays as it is."""
    if len(curve.modifiers) or len(curve.keyframe_points) < 2:
        return
    cycles = curve.modifiers.new("CYCLES")
    mode = "REPEAT_OFFSET" if goes_on else "REPEAT"
    cycles.mode_before = cycles.mode_after = mode  # type: ignore[attr-defined]
