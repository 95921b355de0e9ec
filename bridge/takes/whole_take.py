"""A take with an adapted motion in it: as it was before, blended in and out, and what follows."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass, replace

import bpy
import numpy as np

from ...solver.arrays import FloatArray
from ...solver.data.recording import PoseTrack
from ...solver.data.reports.keys import BlendReport
from ..accessors import current_scene
from ..action_slots import all_curves
from ..armature import fcurves
from ..armature.actions import note_take, slices_showing
from ..armature.incremental import Incremental, sample_incrementally
from ..armature.pose_basis import pose_bases
from ..armature.poses import Poses, frames_per_second, metres_per_unit
from ..armature.steady_joints import steady_bases
from ..companions.found import Companions, found_companions, holders_of
from ..companions.moves import differs, following_bases, root_basis
from ..controls.control_rig import ControlRig, carried_controls, control_poses, found_controls
from ..controls.driven import is_driven
from ..controls.missed.kept import kept_by
from ..controls.targets import targets_of
from .joining.carry import carried_points, slid_in_blend
from .key_splice import FullTurns, anchor, applied, retime, splice
from .owned import (
    OwnedChannel,
    carrying_bones,
    company_channels,
    owned_by,
    owned_channels,
    steady_channels,
)
from .plain_root import plain_poses
from .plan import AdaptedMotion, Plan, planned
from .span import ResultSpan, WrittenTake
from .take_time import TakeTime
from .tracks import joined_tracks, places_of, shares_carried

_RETIMED_A_SLICE = 10  # curves


@dataclass(frozen=True)
class _Copy:
    """The copy of a take that becomes a result. seen: bones of which poses are wanted after the
    body's frames; None where keys alone do not tell them."""

    armature: bpy.types.Object
    action: bpy.types.Action
    curves: fcurves.CurveHolder
    plan: Plan
    seen: tuple[str, ...] | None

    @property
    def showing(self) -> Callable[[], AbstractContextManager[None]]:
        """Contexts in which the armature performs it, for the slices of one reading."""
        return slices_showing(self.armature, self.action)

    def poses(self) -> Incremental[tuple[Poses, Poses | None]]:
        """As its keys are now: at the body's frames, and at those that follow, if there are any."""
        self.action.update_tag()
        poses = yield from sample_incrementally(self.armature, self.plan.body_frames, self.showing)
        frames, later = self.plan.rest_frames, None
        if len(frames) and self.seen is not None:
            later = plain_poses(self.armature, self.curves, self.seen, frames)
        if len(frames) and later is None:
            later = yield from sample_incrementally(self.armature, frames, self.showing)
        return poses, later

    def write(self, channel: OwnedChannel, rest: FloatArray, bases: FloatArray) -> None:
        """Put a bone's bases (T, 4, 4) at the body's frames, and those that follow, into its
        curves. rest: (n,) of the channel, where nothing animates it."""
        plan, curves = self.plan, self.curves
        frames = np.concatenate([plan.body_frames, plan.rest_frames])[: len(bases)]
        recorded = channel.recorded(curves, rest, frames)
        values = channel.values(self.armature, bases, recorded)
        goes_on = plan.span.blend_out > 0.0 or len(frames) > len(plan.body_frames)
        turns = channel.turns(values, recorded) if goes_on else [FullTurns()] * values.shape[1]
        for index, column in enumerate(values.T):
            curve = fcurves.ensured(curves, channel.path, index, channel.bone)
            anchor(curve, plan.between(channel), plan.beside(channel), rest[index])
            splice(curve, frames, column, plan.between(channel), turns[index])


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
    showing = slices_showing(armature, action)
    apart = () if rig is None else tuple(rig.used)
    company = yield from found_companions(armature, curves, bones, apart, showing)
    roots, following = company_channels(armature, curves, company, motion.moved)
    owned = tuple(owned_channels(armature, bones) if rig is None else owned_by(rig, curves))
    every = (*owned, *roots, *following)
    plan = planned(curves, motion)
    alone = None
    if motion.options.others_stay:
        above = holders_of(armature, company, bones)
        alone = {channel.path for channel in every} | _paths_of(curves, {*company.bones, *above})
    yield from _retime(action, curves, alone, plan.time)
    with showing():
        rests = {channel: channel.at_rest(armature) for channel in every}
    done = _apply_modifiers(curves, rests, plan.span)
    carrying = carrying_bones(armature, bones) if rig is None else bones[:1]
    seen = (*(carrying if plan.back is None else bones), *company.bones)
    copy = _Copy(armature, action, curves, plan, seen if rig is None else None)
    poses, later = was = yield from copy.poses()
    shares, slide = shares_carried(poses, later, plan, bones)
    body, rest, blends = joined_tracks(poses, later, plan, motion, (carrying, shares))
    yield None
    if roots:  # under which the body is posed then
        bases = _root_bases(armature, roots, was, (body, rest))
        for channel in roots:
            copy.write(channel, rests[channel], bases)
        poses, later = yield from copy.poses()
    steady: dict[str, FloatArray] = {}
    held: dict[OwnedChannel, FloatArray] = {}
    if rig is None:
        steady, held = yield from _steady(copy, poses, take, motion)
    done += _apply_modifiers(curves, held, plan.span)
    carriers = {channel.bone for channel in owned if channel.carries}
    posed = yield from _bases(copy, rig, ((poses, later), (body, rest)), steady, carriers)
    for channel, at_rest in ({each: rests[each] for each in owned} | held).items():
        copy.write(channel, at_rest, posed[channel.bone])
        yield None
    followed = {channel: rests[channel] for channel in following}
    company = yield from _follow(copy, company, was, bones[0], followed)
    if motion.ends:
        for curve in all_curves(action):
            fcurves.crop(curve, min(plan.span.begin, plan.span.first), plan.span.last)
    action.update_tag()
    note_take(armature, action, take)
    kept = None
    if rig is not None:
        shown = yield from sample_incrementally(armature, plan.body_frames, showing)
        kept = kept_by(shown, targets_of(armature, was[0], body), len(rig.used))
    blends = yield from _with_slides(copy, was[0], blends, motion.touching)
    bones_held = tuple(dict.fromkeys(channel.bone for channel in held))
    about = plan.span, plan.moved, plan.back, plan.time
    written = (*owned, *roots, *held, *(each for each in following if each.bone in company.bones))
    paths = frozenset(channel.path for channel in written)
    return WrittenTake(*about, done, bones_held, kept, rig, paths, slide, blends, company)


def _root_bases(
    armature: bpy.types.Object,
    roots: tuple[OwnedChannel, ...],
    was: tuple[Poses, Poses | None],
    tracks: tuple[PoseTrack, PoseTrack | None],
) -> FloatArray:
    """(T, 4, 4) bases of a root bone, at the body's frames and those that follow. roots: its
    channels."""
    return np.concatenate(
        [
            root_basis(armature, roots[0].bone, poses, track, turns=len(roots) > 1)
            for poses, track in zip(was, tracks, strict=True)
            if poses is not None and track is not None
        ]
    )


def _steady(
    copy: _Copy, poses: Poses, take: bpy.types.Action, motion: AdaptedMotion
) -> Incremental[tuple[dict[str, FloatArray], dict[OwnedChannel, FloatArray]]]:
    """The bases of bones that hold joints, steady; and their channels, with these at rest."""
    armature, bones = copy.armature, motion.track.bones
    recording, frames = slices_showing(armature, take), motion.recorded_frames
    steady = yield from steady_bases(armature, poses, bones, frames, recording, copy.plan.shares)
    channels = tuple(steady_channels(armature, copy.curves, bones, steady))
    with copy.showing():
        return steady, {channel: channel.at_rest(armature) for channel in channels}


def _bases(
    copy: _Copy,
    rig: ControlRig | None,
    wanted: tuple[tuple[Poses, Poses | None], tuple[PoseTrack, PoseTrack | None]],
    steady: Mapping[str, FloatArray],
    carriers: Iterable[str],
) -> Incremental[dict[str, FloatArray]]:
    """Pose bases (T, 4, 4) of bones, or of a rig's controls, with which bodies are on tracks; of
    carriers at the frames that follow, too. wanted: what is shown now, and the tracks."""
    (poses, later), (body, rest) = wanted
    if rig is None:
        bases = yield from pose_bases(copy.armature, poses, body, steady)
    else:
        bases = (yield from control_poses(rig, poses, body, copy.showing)).bases
    if later is not None and rest is not None:
        if rig is None:
            more = yield from pose_bases(copy.armature, later, rest, {})
        else:
            more = yield from carried_controls(rig, later, rest, copy.showing)
        bases |= {bone: np.concatenate([bases[bone], more[bone]]) for bone in carriers}
    return bases


def _follow(
    copy: _Copy,
    company: Companions,
    was: tuple[Poses, Poses | None],
    pelvis: str,
    rests: Mapping[OwnedChannel, FloatArray],
) -> Incremental[Companions]:
    """Put what keeps its place on the body back there, once that is written; returns what of it had
    left its place. was: the take's poses. rests: of the channels."""
    if not company.followers:
        return company
    now, later = yield from copy.poses()
    bases = following_bases(copy.armature, company.followers, was[0], now)
    left = {name for name, basis in bases.items() if differs(copy.armature, now, name, basis)}
    if later is not None and was[1] is not None:  # where the figure is moved as one
        riding = [(name, pelvis) for name, _ in company.followers]
        for name, basis in following_bases(copy.armature, riding, was[1], later).items():
            if name in bases and differs(copy.armature, later, name, basis):
                bases[name] = np.concatenate([bases[name], basis])
                left.add(name)
    for channel in (each for each in rests if each.bone in left):
        further = len(bases[channel.bone]) > len(copy.plan.body_frames)
        copy.write(replace(channel, carries=further), rests[channel], bases[channel.bone])
        yield None
    return replace(company, followers=tuple(e for e in company.followers if e[0] in left))


def _controls(
    armature: bpy.types.Object, action: bpy.types.Action, motion: AdaptedMotion
) -> Incremental[ControlRig | None]:
    """The controls of a rig whose bodies follow such, as they are in the take's copy."""
    if not is_driven(armature, motion.track.bones):
        return None
    frames, showing = motion.recorded_frames, slices_showing(armature, action)
    return (yield from found_controls(armature, motion.track.bones, frames, showing))


def _paths_of(curves: fcurves.CurveHolder, bones: Collection[str]) -> set[str]:
    paths = {curve.data_path for curve in curves.fcurves}
    return {path for path in paths if fcurves.bone_of(path) in bones}


def _retime(
    action: bpy.types.Action,
    curves: fcurves.CurveHolder,
    alone: Collection[str] | None,
    time: TakeTime,
) -> Incremental[None]:
    """Move keys to where their frames are in the result; alone: only those of these paths."""
    if time.unchanged:
        return
    every = all_curves(action) if alone is None else list(curves.fcurves)
    for count, curve in enumerate(every):
        if alone is None or curve.data_path in alone:
            retime(curve, time)
        if count % _RETIMED_A_SLICE == 0:
            yield None
    if alone is not None:
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


def _with_slides(
    copy: _Copy, was: Poses, blends: tuple[BlendReport, ...], feet: tuple[str, ...]
) -> Incremental[tuple[BlendReport, ...]]:
    """The blends with how far they take feet along that stand in the take, as it is shown now. was:
    the take's poses at the body's frames. On a way back that is told of the whole way."""
    told, every, plan = [], copy.plan.body_frames, copy.plan
    rate, metres = frames_per_second(current_scene()), metres_per_unit(current_scene())
    for blend in blends:
        inside = (every >= blend.first_frame) & (every <= blend.last_frame)
        if not feet or (plan.back is not None and not blend.into):
            told.append(blend)
            continue
        poses = yield from sample_incrementally(copy.armature, every[inside], copy.showing)
        take = metres * places_of(was, feet)[inside]
        if not blend.into:
            take = carried_points(take, plan.moved)
        slides = slid_in_blend(take, metres * places_of(poses, feet), 1.0 / rate)
        worst = int(slides.argmax())
        told.append(replace(blend, slide_m=float(slides[worst]), slide_bone=feet[worst]))
    return tuple(told)
