"""Where bodies are in a take with an adapted motion in it: joined, blended and carried along."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...solver.arrays import FloatArray
from ...solver.data.recording import PoseTrack
from ...solver.data.reports.keys import BlendReport
from ...solver.data.stance_move import StanceMove
from ..accessors import current_scene
from ..armature.channels import proper
from ..armature.poses import Poses, frames_per_second, metres_per_unit
from .joining.carry import carried, shares_of_return, slid
from .joining.offsets import (
    backwards,
    beginning,
    blend_report,
    faded,
    frames_from,
    frames_until,
    joined,
    rows,
    seam_offset,
)
from .plan import AdaptedMotion, Plan
from .span import ResultSpan


def joined_tracks(
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
    following = frames_from(take, span.last)
    count = len(following.frames)
    goal = _carried(following, plan.moved, shares[:count])
    after = rows(goal, slice(1, None))
    blends = []
    if len(span.after):
        before = frames_until(take, span.last)
        before = _carried(before, plan.moved, np.ones(len(before.frames)))
        offset = seam_offset(backwards(motion.track, rate), backwards(before, rate))
        after = faded(after, offset, after.frames - span.last, span.blend_out)
        shown = joined([rows(motion.track, slice(-1, None)), after])
        blends.append(blend_report(shown, goal, into=False, rate=rate))
    into = list(_blended_in(take, span, motion.track, rate))
    if into:
        shown = joined([*into, rows(motion.track, slice(1))])
        goal = frames_until(take, span.first)
        blends.insert(0, blend_report(shown, goal, into=True, rate=rate))
    if rest is not None:
        rest = _carried(rest, plan.moved, shares[count:])
    return joined([*into, motion.track, after]), rest, tuple(blends)


def shares_carried(
    poses: Poses, later: Poses | None, plan: Plan, bodies: tuple[str, ...]
) -> tuple[FloatArray, float]:
    """Shares of the stance's move from the last adapted frame on, (T,), and how far the way back
    makes standing feet slide, m."""
    following = plan.body_frames >= plan.span.last
    frames = np.concatenate([plan.body_frames[following], plan.rest_frames])
    if plan.back is None:
        return np.ones(len(frames)), 0.0
    assert plan.moved is not None
    places = [places_of(poses, bodies)[following]]
    if later is not None:
        places.append(places_of(later, bodies))
    whole = np.concatenate(places) * metres_per_unit(current_scene())
    shares = shares_of_return(frames, whole, plan.span.last, plan.back)
    return shares, slid(whole, plan.moved, shares)


def places_of(poses: Poses, bodies: tuple[str, ...]) -> FloatArray:
    """(T, B, 3) heads of bodies in the world."""
    columns = [poses.bones.index(body) for body in bodies]
    heads = poses.object_to_world[:, None] @ poses.matrices[:, columns, :, 3:]
    return np.asarray(heads[..., :3, 0])


def _carried(track: PoseTrack, move: StanceMove | None, shares: FloatArray) -> PoseTrack:
    return track if move is None else carried(track, move, shares)


def _blended_in(
    take: PoseTrack, span: ResultSpan, motion: PoseTrack, rate: float
) -> Iterator[PoseTrack]:
    before = rows(take, take.frames < span.first)
    if len(before.frames):
        adapted = frames_from(take, span.first)
        offset = seam_offset(beginning(motion, rate), beginning(adapted, rate))
        yield faded(before, offset, span.first - before.frames, span.blend_in)


def _take_of(poses: Poses, bones: tuple[str, ...], frames: FloatArray) -> PoseTrack:
    """The take's poses as a track: world, m."""
    world = poses.object_to_world[:, None] @ poses.matrices
    columns = [poses.bones.index(bone) for bone in bones]
    heads = world[:, columns[0], :3, 3] * metres_per_unit(current_scene())
    return PoseTrack(frames, bones, proper(world[:, columns, :3, :3]), heads)
