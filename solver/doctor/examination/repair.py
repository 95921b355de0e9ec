"""Repairs of a recording: from a recording to a recording."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace

import numpy as np

from ...analysis.take import require_inside
from ...arrays import FloatArray
from ...body.character import stature
from ...data.faults import NothingLeft
from ...data.problem import Mend, MotionProblem
from ...data.recording import Recording, Skin
from ...data.scaling import scaled_recording
from ...skeleton.bind_pose import bind_frames, last_bind_frames
from ...skeleton.mirror import mirrored
from ..falls import person_factor
from ..figure import Figure, figure_of
from ..frames.exchanges import exchanged_back
from ..frames.flips import unflipped
from ..frames.full_turns import without_full_turns
from ..frames.holds import held_frames
from ..frames.rate_conversion import conversion, evened
from ..frames.spikes import unsound_spikes
from ..lengths import kept_lengths
from ..local_poses import LocalPoses
from ..noise import smoothed
from ..repairs import MissingFrames, Repairs, check_missing
from ..stance.floating import held_to_the_ground
from ..stance.in_place import with_its_way
from ..stance.level_hips import with_its_height
from ..stance.sinking import lifted_out
from ..stretch import Span
from ..upright import turn_upright

GROUNDING = {Mend.LEVEL_HIPS, Mend.IN_PLACE, Mend.FLOATING, Mend.SINKING}
"""What is mended in how the body stands, and not in its poses."""


def repaired(
    recording: Recording, repairs: Repairs, chosen: Mapping[str, str] | None = None
) -> Recording:
    """The recording with all repairs. chosen: bones by parts of the body, as in a problem.

    Raises MissingPart, NotBetweenFrames, NothingLeft.
    """
    upright = _evened_first(turned(recording, repairs), repairs)
    whole = filled(upright, repairs.missing)
    still = placed(mended(trimmed(whole, repairs), repairs, chosen), repairs)
    return grounded(still, repairs.mend, chosen)


def _evened_first(recording: Recording, repairs: Repairs) -> Recording:
    """With a conversion of its rate evened, where frames are put in that would break its beat."""
    if Mend.HELD_FRAMES not in repairs.mend or not repairs.missing:
        return recording
    found = conversion(recording)
    return recording if found is None else evened(recording, found)


def as_asked(recording: Recording, problem: MotionProblem) -> Recording:
    """The recording with what a problem asks to be mended, in its own lengths, without drift from
    the problem's first frame on, held to the ground, and mirrored. Raises MissingPart,
    NotMirrored."""
    still = _without_drift_as_asked(recording, problem)
    still = grounded(still, problem.mend, problem.bones, problem.height)
    first = float(recording.frames[0]) if problem.frames is None else problem.frames[0]
    return mirrored(still, first) if problem.mirrored else still


def floated(recording: Recording, problem: MotionProblem, frame: float) -> tuple[float, ...]:
    """(3,) m, how far the recording is at a frame from where it is held to the ground."""
    if not GROUNDING & set(problem.mend):
        return 0.0, 0.0, 0.0
    before = _without_drift_as_asked(recording, problem)
    moved = GROUNDING & set(problem.mend)  # and nothing smoothed
    after = grounded(before, moved, problem.bones, problem.height)
    at = int(np.argmin(np.abs(before.frames - frame)))
    return tuple((before.heads[at, 0] - after.heads[at, 0]).tolist())


def _without_drift_as_asked(recording: Recording, problem: MotionProblem) -> Recording:
    """With its poses mended, and without drift."""
    if problem.mend:
        moving = _without_rest_poses(recording, problem.frames)
        recording = mended(moving, Repairs(mend=problem.mend), problem.bones)
    first = float(recording.frames[0]) if problem.frames is None else problem.frames[0]
    velocity = *problem.drift, problem.rise
    if any(velocity):
        begins = float(np.interp(first, recording.frames, recording.times))
        recording = _without_drift(recording, recording.times - begins, velocity)
    return recording


def _without_rest_poses(recording: Recording, asked: tuple[float, float] | None) -> Recording:
    """Without those at its ends, as far as they are not among the frames that are asked for: the
    jump between them and the motion would be smoothed into the rest. Of all frames those at the
    beginning are none."""
    held = bind_frames(recording)
    if asked is None or recording.frames[held] <= asked[0]:
        recording = trimmed(recording, Repairs(trim=held))
    last = last_bind_frames(recording)
    if asked is not None and asked[1] <= recording.frames[-1 - last]:
        recording = trimmed(recording, Repairs(trim_end=last))
    return recording


def smoothed_later(mend: Collection[Mend]) -> bool:
    """Whether what trembles is smoothed once the hips have their height: it would blur the speeds
    at which the feet leave the ground, and land."""
    return Mend.LEVEL_HIPS in mend and Mend.NOISE in mend


def grounded(
    recording: Recording,
    mend: Collection[Mend],
    chosen: Mapping[str, str] | None,
    stated: float | None = None,
) -> Recording:
    """With its height and its way along the floor, held to the ground, and lifted out of it, where
    these are among what is to be mended; a single pose as it is. recording: in its right time, and
    without drift. stated: m, how tall the figure is, where its own lengths do not tell. Raises
    MissingPart."""
    wanted = [each for each in Mend if each in mend and each in GROUNDING]
    if not wanted or len(recording.frames) < 2:
        return recording
    height = stature(recording, chosen)
    persons = person_factor(height)  # limits in metres are those of persons
    for each in wanted:
        falls = each is Mend.LEVEL_HIPS  # at its own size, whatever a person's is
        size = stated / height if falls and stated is not None else persons
        mended = _grounded(scaled_recording(recording, size), each, chosen)
        recording = scaled_recording(mended, 1.0 / size)
        if each is Mend.LEVEL_HIPS and smoothed_later(mend):
            recording = smoothed(recording, figure_of(recording, chosen))
    return recording


def _grounded(recording: Recording, mend: Mend, chosen: Mapping[str, str] | None) -> Recording:
    match mend:
        case Mend.LEVEL_HIPS:
            return with_its_height(recording, chosen)
        case Mend.IN_PLACE:
            return with_its_way(recording, chosen)
        case Mend.FLOATING:
            return held_to_the_ground(recording, figure_of(recording, chosen))
        case Mend.SINKING:
            return lifted_out(recording, chosen)
    raise ValueError(f"how does {mend.value} move the body?")


def _without_drift(
    recording: Recording, times: FloatArray, velocity: tuple[float, float, float]
) -> Recording:
    away = times[:, None] * np.array(velocity)
    return replace(recording, heads=recording.heads - away[:, None])


def unplaced(recording: Recording, repairs: Repairs) -> Recording:
    """As it was before it was turned, put on another clock and scale, and on the floor."""
    raised = placed(recording, Repairs(floor=-repairs.floor))
    back = Repairs(time_scale=1.0 / repairs.time_scale, scale=1.0 / repairs.scale)
    return _rotated(placed(raised, back), turn_upright(repairs).T)


def turned(recording: Recording, repairs: Repairs) -> Recording:
    """With the axis that is up along Z, and its floor level."""
    return _rotated(recording, turn_upright(repairs))


def _rotated(recording: Recording, turn: FloatArray) -> Recording:
    """Turned about the world's origin by a rotation (3, 3)."""
    if np.array_equal(turn, np.eye(3)):
        return recording
    bones = tuple(
        replace(b, head=turn @ b.head, tail=turn @ b.tail, rotation=turn @ b.rotation)
        for b in recording.bones
    )
    heads, rotations = recording.heads @ turn.T, turn @ recording.rotations
    return replace(recording, bones=bones, heads=heads, rotations=rotations)


def filled(recording: Recording, missing: tuple[MissingFrames, ...]) -> Recording:
    """With frames put in, on the curve through those around, and taken out; what comes after them
    comes later, or earlier.

    Raises NotBetweenFrames.
    """
    if not missing:
        return recording
    first, last = recording.ends
    check_missing(missing, first, last)
    kept, lacks = taken_out(recording, missing), [gap for gap in missing if gap.count > 0]
    counts = [sum(gap.count for gap in lacks if gap.after < frame) for frame in kept.frames]
    at = np.arange(len(kept.frames)) + np.array(counts)  # where each recorded frame goes
    source = np.searchsorted(at, np.arange(at[-1] + 1))
    unsound = np.isin(np.arange(at[-1] + 1), at, invert=True)
    filled_in = Recording(
        recording.name,
        recording.bones,
        first + np.arange(at[-1] + 1) * (last - first) / (len(recording.frames) - 1),
        recording.times[0] + np.arange(at[-1] + 1) / recording.rate,
        kept.heads[source],
        kept.rotations[source],
    )
    bones = np.broadcast_to(unsound[:, None], filled_in.heads.shape[:2])
    return LocalPoses.of(filled_in).filled(bones).posed(filled_in)


def taken_out(recording: Recording, missing: tuple[MissingFrames, ...]) -> Recording:
    """Without frames that are too many; what comes after them comes earlier, by the numbers that
    its frames had."""
    extra = np.zeros(len(recording.frames), bool)
    for gap in missing:
        extra |= (recording.frames > gap.after) & (recording.frames <= gap.after - gap.count)
    kept = recording.part(~extra)
    times = recording.times[0] + np.arange(len(kept.frames)) / recording.rate
    return replace(kept, times=times) if extra.any() else recording


def check_trim(repairs: Repairs, frames: int) -> None:
    """Whether some of a recording's frames are left. Raises NothingLeft."""
    if repairs.trim + repairs.trim_end >= frames:
        raise NothingLeft(repairs.trim, repairs.trim_end, frames)


def trimmed(recording: Recording, repairs: Repairs) -> Recording:
    """Without the frames at both ends that are left out. Raises NothingLeft."""
    count = len(recording.frames)
    check_trim(repairs, count)
    kept = recording.part(slice(repairs.trim, count - repairs.trim_end))
    return replace(kept, times=kept.times - kept.times[:1])


def left_of(
    recording: Recording, problem: MotionProblem, repairs: Repairs, whole: Span
) -> tuple[Recording, MotionProblem]:
    """A recording, and the frames that a problem asks for, without those that are left out of the
    whole clip, whose first and last frame these are.

    Raises NothingLeft, and OutsideKeys where none that is asked for is left.
    """
    check_trim(repairs, round(whole[1] - whole[0]) + 1)
    if not repairs.trims:
        return recording, problem
    first, last = whole[0] + repairs.trim, whole[1] - repairs.trim_end
    if problem.frames is not None:
        require_inside(problem.frames, recording.name, (first, last))
        asked = max(first, problem.frames[0]), min(last, problem.frames[1])
        problem = replace(problem, frames=asked)
    return recording.window(first, last), problem


def mended(
    recording: Recording, repairs: Repairs, chosen: Mapping[str, str] | None = None
) -> Recording:
    """With its poses mended; frames, clock and lengths stay, and so does how it floats; a single
    pose as it is, and what trembles where `grounded` smooths it. Raises MissingPart."""
    wanted = repairs.mend if len(recording.frames) > 1 else ()
    later = {Mend.NOISE, *GROUNDING} if smoothed_later(wanted) else GROUNDING
    poses = [mend for mend in Mend if mend in wanted and mend not in later]
    figure = figure_of(recording, chosen) if poses else None
    for mend in poses:
        assert figure is not None
        recording = _with(mend, recording, figure)
    return recording


def _with(mend: Mend, recording: Recording, figure: Figure) -> Recording:
    match mend:
        case Mend.FULL_TURNS:
            return without_full_turns(recording, figure)
        case Mend.LEGS | Mend.ARMS:
            return exchanged_back(recording, figure, mend)
        case Mend.FLIPS:
            return unflipped(recording, figure)
        case Mend.SPIKES:
            local = LocalPoses.of(recording)
            unsound = unsound_spikes(recording, local, figure)
            return local.filled(unsound).posed(recording)
        case Mend.HELD_FRAMES:
            if (found := conversion(recording)) is not None:
                return evened(recording, found)
            held = held_frames(recording)
            unsound = np.broadcast_to(held[:, None], recording.heads.shape[:2])
            return LocalPoses.of(recording).filled(unsound).posed(recording)
        case Mend.BONE_LENGTHS:
            return kept_lengths(recording, figure)
        case Mend.NOISE:
            return smoothed(recording, figure)
    raise ValueError(f"how is {mend.value} mended?")


def placed_skin(skin: Skin | None, repairs: Repairs) -> Skin | None:
    """A skin where `repaired` has the rest pose."""
    if skin is None:
        return None
    points = repairs.scale * (skin.points @ turn_upright(repairs).T)
    return replace(skin, points=points - np.array([0.0, 0.0, repairs.floor]))


def unplaced_skin(skin: Skin | None, repairs: Repairs) -> Skin | None:
    """A skin where `unplaced` has the rest pose."""
    if skin is None:
        return None
    raised = skin.points + np.array([0.0, 0.0, repairs.floor])
    return replace(skin, points=raised @ turn_upright(repairs) / repairs.scale)


def placed(recording: Recording, repairs: Repairs) -> Recording:
    """At the scales of time and size, without drift, on the floor at 0."""
    scaled = scaled_recording(recording, repairs.scale)
    times = repairs.time_scale * scaled.times
    lower = np.array([0.0, 0.0, -repairs.floor])
    bones = tuple(replace(b, head=b.head + lower, tail=b.tail + lower) for b in scaled.bones)
    lowered = replace(scaled, bones=bones, times=times, heads=scaled.heads + lower)
    return _without_drift(lowered, times, (*repairs.drift, repairs.rise))
