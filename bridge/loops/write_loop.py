"""Action of a loop: one cycle, a key on every frame, which Blender repeats without a seam."""

from __future__ import annotations

from dataclasses import dataclass, replace

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ...solver.data.faults import NoRootBone
from ...solver.data.recording import PoseTrack
from ..accessors import armature_data, current_scene, pose_of, present, root_of
from ..action_slots import all_curves
from ..armature import fcurves
from ..armature.actions import note_take, recorded_action, show, slices_showing
from ..armature.channels import channels, proper
from ..armature.incremental import Incremental, sample_incrementally
from ..armature.played import scene_copy
from ..armature.pose_basis import carrier_of, pose_bases, with_ancestors
from ..armature.poses import Poses, metres_per_unit
from ..armature.steady_joints import steady_bases
from ..armature.write import remove_other_rotations, rotation_channel
from ..companions.found import Companions, found_companions, holders_of
from ..controls.control_rig import ControlRig, control_poses, found_controls, shifts_of_carriers
from ..controls.driven import is_driven
from ..controls.missed.kept import KeptByControls, kept_by
from ..controls.targets import targets_of
from ..fake_users import guard
from ..properties.settings import settings_of
from ..rows.choices import LoopRoot
from ..takes.owned import owned_by, steady_channels
from ..takes.takes import derive, free_name
from ..takes.write_result import forget_copied
from .company import keep_followers
from .cyclic_keys import repeat, write_cyclic

_TRANSFORMS = ("location", "rotation_", "scale", "delta_")


@dataclass(frozen=True)
class WrittenLoop:
    """What was done to write a loop. controls: how near they bring the bodies to it, where controls
    pose them. companions: the helper bones that are kept on the body."""

    controls: KeptByControls | None
    companions: Companions


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
    def in_place(self) -> PoseTrack:
        """The track without its travel at the mean speed."""
        steady = np.linspace(0.0, 1.0, len(self.track.frames))[:, None] * self.travel
        return replace(self.track, root_head=self.track.root_head - steady)

    @property
    def of_the_body(self) -> PoseTrack:
        """The track without what the pelvis does not carry."""
        return self.track if self.travels and self.root is None else self.in_place

    def moved(self, by: FloatArray) -> Loop:
        """The same one elsewhere, by (3,) m."""
        return replace(self, track=replace(self.track, root_head=self.track.root_head + by))


def root_bone(armature: bpy.types.Object, pelvis: str) -> bpy.types.Bone:
    """The topmost bone above the pelvis, which moves all of the figure. Raises NoRootBone."""
    top = _top_bone(armature, pelvis)
    if top is None:
        raise NoRootBone(armature.name, pelvis)
    return top


def _top_bone(armature: bpy.types.Object, pelvis: str) -> bpy.types.Bone | None:
    bone = armature_data(armature).bones[pelvis]
    above: list[bpy.types.Bone] = bone.parent_recursive
    return None if carrier_of(bone).parent is None else above[-1]


def write_loop(
    armature: bpy.types.Object,
    loop: Loop,
    recorded: bpy.types.Action,
    slot: str | None,
    *,
    name: str,
) -> Incremental[tuple[bpy.types.Action, WrittenLoop]]:
    """Write a loop as a copy of the recording's action, in slices; it is not assigned.

    What carries the body, or helper bones, without being of it holds still as in the cycle's first
    frame. In place the body is brought over a root bone; one that travels does so under the body.
    Helper bones stay on the body. Other channels keep their shape within the cycle, and repeat;
    bones among them, such as fingers, give up evenly what they end away from their start.
    Raises NoControls.
    """
    showing = slices_showing(armature, recorded)
    frames, bodies = loop.track.frames, loop.track.bones
    poses = yield from sample_incrementally(armature, frames, showing)
    rig = None
    if is_driven(armature, bodies):
        rig = yield from found_controls(armature, bodies, frames, showing)
    take = fcurves.holder_in(recorded, slot)
    assert take is not None
    apart = () if rig is None else tuple(rig.used)
    company = yield from found_companions(armature, take, bodies, apart, showing)
    company = replace(company, root=None)
    off_root = _off_root(armature, loop, poses)
    body = loop.moved(-off_root)
    action = scene_copy(armature, recorded, name)
    forget_copied(action)
    whole = False
    try:
        curves = fcurves.holder_in(action, slot)
        assert curves is not None
        _settle_others(
            armature,
            curves,
            loop,
            held={*with_ancestors(armature, bodies), *holders_of(armature, company, bodies)},
            written={*(bodies if rig is None else rig.controls), *company.bones},
        )
        if rig is None:
            steady = yield from steady_bases(armature, poses, bodies, frames, showing)
            yield from _write_bodies(armature, curves, body, poses, steady)
        else:
            yield from _write_controls(rig, action, curves, body, off_root)
        if loop.root is not None and (rig is None or loop.root.name not in rig.carriers):
            _write_root(armature, curves, loop.root, loop, poses, off_root)
        company = yield from keep_followers(armature, action, curves, company, frames, poses)
        for curve in all_curves(action):
            repeat(curve)
        action.use_frame_range = action.use_cyclic = True
        action.frame_start, action.frame_end = frames[[0, -1]].tolist()
        note_take(armature, action, recorded)
        kept = None
        if rig is not None:
            kept = yield from _kept(rig, action, loop if loop.travels else body)
        whole = True
    finally:
        if not whole:  # cancelled in between: half an action is of no use to anybody
            bpy.data.actions.remove(action)
    guard(recorded)
    return action, WrittenLoop(kept, company)


def write_loop_incrementally(
    armature: bpy.types.Object, loop: Loop
) -> Incremental[tuple[bpy.types.Action, WrittenLoop]]:
    """Write a loop as a new action, which is assigned and knows its recording.

    Before the last slice the armature is as it was. Returns and raises as `write_loop`.
    """
    original, slot = present(recorded_action(armature)), fcurves.slot_identifier(armature)
    name = free_name(root_of(original).name, "loop")
    action, written = yield from write_loop(armature, loop, original, slot, name=name)
    derive(action, original, armature)
    show(armature, action, slot)
    settings_of(armature).adapted = action
    return action, written


def _write_bodies(
    armature: bpy.types.Object,
    curves: fcurves.CurveHolder,
    loop: Loop,
    poses: Poses,
    steady: dict[str, FloatArray],
) -> Incremental[None]:
    """Key the bodies' own bones, and those that hold joints, steady. poses: the recording's."""
    frames, bones = loop.track.frames, pose_of(armature).bones
    bases = yield from pose_bases(armature, _held(poses), loop.of_the_body, steady)
    for channel in steady_channels(armature, curves, loop.track.bones, steady):
        basis = bases[channel.bone]
        values = channel.values(armature, basis, channel.at_rest(armature)[None])
        write_cyclic(curves, channel.path, channel.bone, frames, values, goes_on=False)
    for bone in loop.track.bones:
        _write_rotation(curves, bones[bone], frames, bases[bone])
        yield None
    carrier = carrier_of(armature_data(armature).bones[loop.track.bones[0]]).name
    places, goes_on = bases[carrier][:, :3, 3], loop.travels and loop.root is None
    path = bones[carrier].path_from_id("location")
    write_cyclic(curves, path, carrier, frames, places, goes_on=goes_on)


def _write_controls(
    rig: ControlRig,
    action: bpy.types.Action,
    curves: fcurves.CurveHolder,
    loop: Loop,
    start: FloatArray,
) -> Incremental[None]:
    """Key the controls such that the bodies follow the cycle in place; the travel goes to those
    that carry the figure, after a first move of them by start (3,) m, world.

    The curves are settled: what the controls are solved from ends as it begins.
    """
    frames, armature = loop.track.frames, rig.armature
    showing = slices_showing(armature, action)
    action.update_tag()
    poses = yield from sample_incrementally(armature, frames, showing)
    bases = (yield from control_poses(rig, poses, loop.in_place, showing)).bases
    carried = loop.travels and (loop.root is None or loop.root.name in rig.carriers)
    with showing():
        begin, travel = (
            shifts_of_carriers(rig, float(frames[0]), move) for move in (start, loop.travel)
        )
        rests = {channel: channel.at_rest(armature) for channel in owned_by(rig, curves)}
    for channel, rest in rests.items():
        recorded = channel.recorded(curves, rest, frames[:1])
        values = channel.values(armature, bases[channel.bone], recorded)
        goes_on = carried and channel.carries and channel.attribute == "location"
        if goes_on:
            values = np.concatenate([values[:-1], values[:1]])
            values += np.linspace(0.0, 1.0, len(frames))[:, None] * travel[channel.bone]
            values += begin[channel.bone]
        write_cyclic(curves, channel.path, channel.bone, frames, values, goes_on=goes_on)
        yield None


def _kept(rig: ControlRig, action: bpy.types.Action, loop: Loop) -> Incremental[KeptByControls]:
    """How near the bodies are to the cycle, as Blender shows the action."""
    action.update_tag()
    showing = slices_showing(rig.armature, action)
    shown = yield from sample_incrementally(rig.armature, loop.track.frames, showing)
    track = loop.track if loop.travels else loop.in_place
    return kept_by(shown, targets_of(rig.armature, shown, track), len(rig.used))


def _held(poses: Poses) -> Poses:
    """The first pose at all frames."""
    return replace(
        poses,
        object_to_world=np.repeat(poses.object_to_world[:1], len(poses.matrices), axis=0),
        matrices=np.repeat(poses.matrices[:1], len(poses.matrices), axis=0),
    )


def _settle_others(
    armature: bpy.types.Object,
    curves: fcurves.CurveHolder,
    loop: Loop,
    *,
    held: set[str],
    written: set[str],
) -> None:
    """Hold the object, and bones that carry some of the figure and are not written, as at the
    cycle's first frame; cut all else, and close what other bones do."""
    first, last = (float(loop.track.frames[k]) for k in (0, -1))
    paths = tuple(pose_of(armature).bones[name].path_from_id() for name in held - written)
    for curve in list(curves.fcurves):
        if not len(curve.keyframe_points):
            continue
        if curve.data_path.startswith(_TRANSFORMS) or _is_of(curve, paths):
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
    write_cyclic(curves, bone.path_from_id(used), bone.name, frames, values, goes_on=False)


def _off_root(armature: bpy.types.Object, loop: Loop, poses: Poses) -> FloatArray:
    """(3,) m, level, world: how far the middle of the hips' sway is from over the root bone, where
    they are at rest; 0 without one, and where the hips travel by themselves. poses: the
    recording's, in whose first the root is held."""
    pelvis = armature_data(armature).bones[loop.track.bones[0]]
    root = _top_bone(armature, pelvis.name)
    if root is None or (loop.travels and loop.root is None):
        return np.zeros(3)
    beside = np.array(root.matrix_local.inverted() @ pelvis.matrix_local)
    over = poses.object_to_world[0] @ poses.matrices[0, poses.bones.index(root.name)] @ beside
    middle = loop.in_place.root_head.mean(axis=0)
    return np.asarray((middle - metres_per_unit(current_scene()) * over[:3, 3]) * [1.0, 1.0, 0.0])


def _write_root(
    armature: bpy.types.Object,
    curves: fcurves.CurveHolder,
    root: bpy.types.Bone,
    loop: Loop,
    poses: Poses,
    start: FloatArray,
) -> None:
    """Let the root bone travel. start (3,) m, world: from where the recording's first frame has
    it."""
    frames = loop.track.frames
    there = poses.matrices[0, poses.bones.index(root.name)]
    to_bone = poses.object_to_world[0, :3, :3]
    if root.use_local_location:
        to_bone = to_bone @ np.array(root.matrix_local, float)[:3, :3]
    rest = np.linalg.solve(np.array(root.matrix_local, float), there)[:3, 3]
    if not root.use_local_location:
        rest = there[:3, 3] - np.array(root.matrix_local, float)[:3, 3]
    share = np.linspace(0.0, 1.0, len(frames))[:, None]
    moves = (start + share * loop.travel) / metres_per_unit(current_scene())
    values = rest + moves @ np.linalg.inv(to_bone).T
    path = pose_of(armature).bones[root.name].path_from_id("location")
    write_cyclic(curves, path, root.name, frames, values, goes_on=True)
