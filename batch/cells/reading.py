"""Reading of clips without Blender: BVH and Acclaim files, in the same steps as `headless.clip`."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import ceil, floor
from pathlib import Path

from ...bridge.formats.acclaim import find_asf, read_acclaim
from ...bridge.formats.bvh import read_bvh
from ...bridge.formats.guess import guess_unit, guess_up
from ...bridge.formats.motion_clip import MotionClip, UpAxis, to_recording
from ...bridge.formats.paths import require_readable
from ...solver.analysis.take import require_inside
from ...solver.data.problem import MotionProblem
from ...solver.data.recording import BEYOND, Recording
from ...solver.data.reports.recording import Origin
from ...solver.doctor.examination.repair import (
    filled,
    grounded,
    left_of,
    mended,
    placed,
    turned,
)
from ...solver.doctor.repairs import Repairs
from ...solver.doctor.stretch import Span
from ...solver.skeleton.bind_pose import bind_frames
from ...solver.worker.stated_scale import check_scale

_EPSILON = 1e-4  # frames, by which a bound may miss a whole one


@dataclass(frozen=True)
class ReadClip:
    """A clip's recording, repaired, and how its file was read.

    problem: as it was asked for, after a bind pose. unit: m per unit of the file. up: its axis that
    points up. whole: first and last frame of all that the file holds.
    """

    recording: Recording
    origin: Origin
    problem: MotionProblem
    unit: float
    up: UpAxis
    whole: Span


def read_file(path: Path, rate: float | None) -> MotionClip:
    """A BVH or AMC file as it is. rate: Hz, in place of what a BVH tells. Raises ClipNotOpened,
    UnreadableClip, NonFiniteKey."""
    require_readable(path)
    if path.suffix.lower() == ".bvh":
        return read_bvh(path, rate)
    return read_acclaim(find_asf(path), path, rate)


def read_clip(
    path: Path,
    problem: MotionProblem,
    repairs: Repairs | None = None,
    *,
    unit: float | None = None,
    up: UpAxis | None = None,
    rate: float | None = None,
) -> ReadClip:
    """The problem's frames of a clip, and what lies about them; without frames all after a bind
    pose. What the file does not tell and is not given is guessed. Raises as `read_file`,
    MissingPart, NotBetweenFrames, NothingLeft, OddScale and OutsideKeys."""
    clip = read_file(path, rate)
    axis = up or guess_up(clip)
    metres = unit or clip.unit or guess_unit(clip)
    guessed = unit is None and clip.unit is None
    origin = Origin(
        *(path.name, metres, guessed, axis, up is None),
        miscount=clip.miscount,
        unmoved=clip.unmoved,
    )
    recording = _by_depth(to_recording(replace(clip, name=path.stem), metres, axis))
    mend = repairs or Repairs()
    recording = filled(recording, mend.missing)
    whole = recording.ends
    still = replace(mend, drift=Repairs().drift, rise=0.0)
    if still != Repairs():
        recording = placed(turned(recording, still), still)
    check_scale(recording, problem, mend.scale)
    recording = _about(recording, problem, 1.0 / (clip.frame_time * mend.time_scale))
    recording, problem = left_of(recording, problem, mend, whole)
    count = bind_frames(recording) if problem.frames is None else 0
    if count:
        origin = replace(origin, bind_frames=count)
        problem = replace(problem, frames=recording.part(slice(count, None)).ends)
    recording = placed(
        mended(recording, mend, problem.bones), Repairs(drift=mend.drift, rise=mend.rise)
    )
    recording = grounded(recording, mend.mend, problem.bones, problem.height)
    return ReadClip(recording, origin, problem, metres, axis, whole)


def _by_depth(recording: Recording) -> Recording:
    """With its bones level by level, as they are read from an armature: sums over bodies then have
    the same order, and a solve from either reading the same end."""
    depths: list[int] = []
    for bone in recording.bones:
        depths.append(0 if bone.parent < 0 else depths[bone.parent] + 1)
    order = sorted(range(len(depths)), key=depths.__getitem__)
    at = {old: new for new, old in enumerate(order)}
    bones = tuple(
        replace(recording.bones[old], parent=at.get(recording.bones[old].parent, -1))
        for old in order
    )
    heads, rotations = recording.heads[:, order], recording.rotations[:, order]
    return replace(recording, bones=bones, heads=heads, rotations=rotations)


def _about(recording: Recording, problem: MotionProblem, rate: float) -> Recording:
    """The problem's frames and BEYOND seconds on both sides, as far as the clip goes. rate: Hz.

    Raises OutsideKeys, ClipTooShort.
    """
    if problem.frames is None:
        return recording
    start, end = recording.ends
    require_inside(problem.frames, recording.name, (start, end))
    first = ceil(max(problem.frames[0], start) - _EPSILON)
    last = max(first, floor(min(problem.frames[1], end) + _EPSILON))
    reach = floor(BEYOND * rate)
    return recording.window(min(first - reach, end), max(last + reach, start))
