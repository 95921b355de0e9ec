"""A take with an adapted motion in it: as it was before, blended in and out, and what follows."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import partial

import bpy
import numpy as np

from ...solver.arrays import BoolArray, FloatArray
from ...solver.data.recording import PoseTrack
from ...solver.data.reports.keys import BlendReport
from ...solver.data.stance_move import StanceMove
from ..accessors import current_scene
from ..action_slots import all_curves
from ..armature import fcurves
from ..armature.actions import note_take, showing_action
from ..armature.channels import proper
from ..armature.incremental import Incremental, sample_incrementally
from ..armature.pose_basis import pose_bases
from ..armature.poses import Poses, frames_per_second, metres_per_unit
from ..armature.steady_joints import steady_bases
from ..controls.control_rig import (
    ControlRig,
    carried_controls,
    control_poses,
    found_controls,
)
from ..controls.driven import is_driven
from ..controls.kept import kept_by
from ..controls.targets import targets_of
from .carry import carried, shares_of_return, slid
from .key_splice import FullTurns, anchor, applied, retime, splice
from .offsets import blend_report, faded, seam_offset
from .owned import OwnedChannel, carrying_bones, owned_by, owned_channels, steady_channels
from .plain_root import plain_poses
from .plan import AdaptedMotion, Plan, planned
from .span import ResultSpan, WrittenTake
from .take_time import TakeTime

_SEAM_FRAMES = 3  # of which the speed at a seam is taken
_RETIMED_A_SLICE = 10  # curves


def write_take(
    armature: bpy.types.Object,
    action: bpy.types.Action,
    take: bpy.types.Action,
    slot: str | None,
    motion: AdaptedMotion,
) -> Incremental[WrittenTake]:
    """Put a motion into an action, which is a copy of the take's; in slices.

    Keys outside of the adapted and blended frames stay as they are, bit by bit, but for their time
    where durations changed, and for those that carry the figure where what follows is moved.
    """
    curves = fcurves.holder_in(action, slot)
    assert curves is not None
    bones = motion.track.bones
    rig = yield from _controls(armature, action, motion)
    owned = tuple(owned_channels(armature, bones) if rig is None else owned_by(rig, curves))
    carrying = carrying_bones(armature, bones) if rig is None else bones[:1]
    plan = planned(curves, motion)
    yield from _retime(action, curves, owned, plan.time, alone=motion.options.others_stay)
    showing = partial(showing_action, armature, action)
    with showing():
        rests = {channel: channel.at_rest(armature) for channel in owned}
    done = _apply_modifiers(curves, rests, plan.span)
    action.update_tag()
    poses = yield from sample_incrementally(armature, plan.body_frames, showing)
    later = None
    if len(plan.rest_frames):
        if rig is None:
            looked_at = carrying if plan.back is None else bones
            later = plain_poses(armature, curves, looked_at, plan.rest_frames)
        if later is None:
            later = yield from sample_incrementally(armature, plan.rest_frames, showing)
    shares, slide = _shares(poses, later, plan, bones)
    body, rest, blends = _tracks(poses, later, plan, motion, (carrying, shares))
    yield None
    held: dict[OwnedChannel, FloatArray] = {}
    if rig is None:
        recording = partial(showing_action, armature, take)
        steady = yield from steady_bases(
            armature, poses, bones, motion.recorded_frames, recording, plan.shares
        )
        moving = tuple(steady_channels(armature, curves, bones, steady))
        with showing():
            held = {channel: channel.at_rest(armature) for channel in moving}
        rests |= held
        done += _apply_modifiers(curves, held, plan.span)
        bases = yield from pose_bases(armature, poses, body, steady)
    else:
        bases = (yield from control_poses(rig, poses, body, showing)).bases
    if later is not None and rest is not None:
        if rig is None:
            more = yield from pose_bases(armature, later, rest, {})
        else:
            more = yield from carried_controls(rig, later, rest, showing)
        bases |= {c.bone: np.concatenate([bases[c.bone], more[c.bone]]) for c in owned if c.carries}
    for channel in rests:
        _write_channel(armature, curves, channel, rests[channel], bases[channel.bone], plan)
        yield None
    if motion.ends:
        for curve in all_curves(action):
            fcurves.crop(curve, min(plan.span.begin, plan.span.first), plan.span.last)
    action.update_tag()
    note_take(armature, action, take)
    kept = None
    if rig is not None:
        shown = yield from sample_incrementally(armature, plan.body_frames, showing)
        kept = kept_by(shown, targets_of(armature, poses, body), len(rig.used))
    bones_held = tuple(dict.fromkeys(channel.bone for channel in held))
    about = plan.span, plan.moved, plan.back, plan.time
    return WrittenTake(*about, done, bones_held, kept, rig, slide, blends)


def _controls(
    armature: bpy.types.Object, action: bpy.types.Action, motion: AdaptedMotion
) -> Incremental[ControlRig | None]:
    """The controls of a rig whose bodies follow such, as they are in the take's copy."""
    if not is_driven(armature, motion.track.bones):
        return None
    frames, showing = motion.recorded_frames, partial(showing_action, armature, action)
    return (yield from found_controls(armature, motion.track.bones, frames, showing))


def _retime(
    action: bpy.types.Action,
    curves: fcurves.CurveHolder,
    owned: Iterable[OwnedChannel],
    time: TakeTime,
    *,
    alone: bool,
) -> Incremental[None]:
    """Move keys to where their frames are in the result; alone: only those of owned channels."""
    if time.unchanged:
        return
    mine = {channel.path for channel in owned}
    every = list(curves.fcurves) if alone else all_curves(action)
    for count, curve in enumerate(every):
        if not alone or curve.data_path in mine:
            retime(curve, time)
        if count % _RETIMED_A_SLICE == 0:
            yield None
    if alone:
        return
    for marker in action.pose_markers:
        marker.frame = round(float(time.to_result(np.array([marker.frame]))[0]))
    if action.use_frame_range:
        ends = time.to_result(np.array([action.frame_start, action.frame_end]))
        action.frame_start, action.frame_end = ends.tolist()


def _apply_modifiers(
    curves: fcurves.CurveHolder, rests: dict[OwnedChannel, FloatArray], span: ResultSpan
) -> tuple[str, ...]:
    """Make keys of owned curves that have modifiers or are muted, which would act on new keys."""
    frames = np.arange(np.floor(span.begin), np.ceil(span.end) + 1.0)
    bones = []
    for channel, rest in rests.items():
        for curve in (c for c in curves.fcurves if c.data_path == channel.path):
            if len(curve.modifiers) or curve.mute:
                applied(curve, frames, rest[curve.array_index] if curve.mute else None)
                bones.append(channel.bone)
    return tuple(dict.fromkeys(bones))


def _tracks(
    poses: Poses,
    later: Poses | None,
    plan: Plan,
    motion: AdaptedMotion,
    carrying: tuple[tuple[str, ...], FloatArray],
) -> tuple[PoseTrack, PoseTrack | None, tuple[BlendReport, ...]]:
    """Poses of all bodies at the body's frames, and of those that carry them at the frames that
    follow; and how the blends move the hips. carrying: these, and the shares (T,) of the stance's
    move from the last adapted frame on."""
    span, rate = plan.span, frames_per_second(current_scene())
    carriers, shares = carrying
    take = _take_of(poses, motion.track.bones, plan.body_frames)
    rest = None
    if later is not None:
        rest = _take_of(later, carriers, plan.rest_frames)
    following = _frames_from(take, span.last)
    count = len(following.frames)
    goal = _carried(following, plan.moved, shares[:count])
    after = _rows(goal, slice(1, None))
    blends = []
    if len(span.after):
        before = _frames_until(take, span.last)
        before = _carried(before, plan.moved, np.ones(len(before.frames)))
        offset = seam_offset(_backwards(motion.track), _backwards(before))
        after = faded(after, offset, after.frames - span.last, span.blend_out)
        shown = _concatenated([_rows(motion.track, slice(-1, None)), after])
        blends.append(blend_report(shown, goal, into=False, rate=rate))
    into = list(_blended_in(take, span, motion.track))
    if into:
        shown = _concatenated([*into, _rows(motion.track, slice(1))])
        goal = _frames_until(take, span.first)
        blends.insert(0, blend_report(shown, goal, into=True, rate=rate))
    if rest is not None:
        rest = _carried(rest, plan.moved, shares[count:])
    return _concatenated([*into, motion.track, after]), rest, tuple(blends)


def _shares(
    poses: Poses, later: Poses | None, plan: Plan, bodies: tuple[str, ...]
) -> tuple[FloatArray, float]:
    """Shares of the stance's move from the last adapted frame on, (T,), and how far the way back
    makes standing feet slide, m."""
    following = plan.body_frames >= plan.span.last
    frames = np.concatenate([plan.body_frames[following], plan.rest_frames])
    if plan.back is None:
        return np.ones(len(frames)), 0.0
    assert plan.moved is not None
    places = [_places(poses, bodies)[following]]
    if later is not None:
        places.append(_places(later, bodies))
    whole = np.concatenate(places) * metres_per_unit(current_scene())
    shares = shares_of_return(frames, whole, plan.span.last, plan.back)
    return shares, slid(whole, plan.moved, shares)


def _places(poses: Poses, bodies: tuple[str, ...]) -> FloatArray:
    """(T, B, 3) heads of bodies in the world."""
    columns = [poses.bones.index(body) for body in bodies]
    heads = poses.object_to_world[:, None] @ poses.matrices[:, columns, :, 3:]
    return np.asarray(heads[..., :3, 0])


def _carried(track: PoseTrack, move: StanceMove | None, shares: FloatArray) -> PoseTrack:
    return track if move is None else carried(track, move, shares)


def _blended_in(take: PoseTrack, span: ResultSpan, motion: PoseTrack) -> Iterator[PoseTrack]:
    before = _rows(take, take.frames < span.first)
    if len(before.frames):
        offset = seam_offset(_start(motion), _start(_frames_from(take, span.first)))
        yield faded(before, offset, span.first - before.frames, span.blend_in)


def _take_of(poses: Poses, bones: tuple[str, ...], frames: FloatArray) -> PoseTrack:
    """The take's poses as a track: world, m."""
    world = poses.object_to_world[:, None] @ poses.matrices
    columns = [poses.bones.index(bone) for bone in bones]
    heads = world[:, columns[0], :3, 3] * metres_per_unit(current_scene())
    return PoseTrack(frames, bones, proper(world[:, columns, :3, :3]), heads)


def _rows(track: PoseTrack, keep: BoolArray | slice) -> PoseTrack:
    return replace(
        track,
        frames=track.frames[keep],
        rotations=track.rotations[keep],
        root_head=track.root_head[keep],
    )


def _frames_from(track: PoseTrack, frame: float) -> PoseTrack:
    return _rows(track, track.frames >= frame)


def _frames_until(track: PoseTrack, frame: float) -> PoseTrack:
    return _rows(track, track.frames <= frame)


def _start(track: PoseTrack) -> PoseTrack:
    return _rows(track, slice(_SEAM_FRAMES))


def _backwards(track: PoseTrack) -> PoseTrack:
    """The last frames, the last one first."""
    return _start(_rows(track, slice(None, None, -1)))


def _concatenated(tracks: list[PoseTrack]) -> PoseTrack:
    return PoseTrack(
        np.concatenate([track.frames for track in tracks]),
        tracks[0].bones,
        np.concatenate([track.rotations for track in tracks]),
        np.concatenate([track.root_head for track in tracks]),
    )


def _write_channel(
    armature: bpy.types.Object,
    curves: fcurves.CurveHolder,
    channel: OwnedChannel,
    rest: FloatArray,
    bases: FloatArray,
    plan: Plan,
) -> None:
    """Put a bone's bases (T, 4, 4) at the body's frames, and those that follow, into its curves.

    rest: (n,) of the channel, where nothing animates it.
    """
    frames = np.concatenate([plan.body_frames, plan.rest_frames])[: len(bases)]
    recorded = channel.recorded(curves, rest, frames)
    values = channel.values(armature, bases, recorded)
    goes_on = plan.span.blend_out > 0.0 or len(frames) > len(plan.body_frames)
    turns = channel.turns(values, recorded) if goes_on else [FullTurns()] * values.shape[1]
    for index, column in enumerate(values.T):
        curve = fcurves.ensured(curves, channel.path, index, channel.bone)
        anchor(curve, plan.between(channel), plan.beside(channel), rest[index])
        splice(curve, frames, column, plan.between(channel), turns[index])
