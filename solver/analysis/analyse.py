"""Analysis pipeline: character, performance and corrected contact schedule of a recording.

The whole way to an adapted motion:

analysis = analyse(recording, problem)      # character, contacts
fitted = fit(analysis.performance, analysis.schedule)
adaptation = adapt(fitted, problem)
track = adaptation.motion.track(analysis.performance.recording)
"""

from dataclasses import dataclass, replace

import numpy as np

from ..body.character import Character, build_character
from ..contacts.events import numbered
from ..data.contacts import ContactSchedule
from ..data.faults import CarriedBy, ClipTooShort, FramesFarApart, FramesReversed
from ..data.problem import MotionProblem, Unseen
from ..data.recording import MIN_CLIP_DURATION, Recording, Skin
from ..unseen.free_fall import falls_beside_unseen, unseen_support
from .carried_by import unseen_carriers, weight_beside
from .corrections import corrected
from .grounding import disjoint, foot_sized, grounded, parted
from .performance import Performance, find_contacts, perform
from .take import take_of

ROUNDING = 1e-6  # of a frame's time
MAX_FRAME_TIME = 0.125  # s: the flight of a small hop, a quarter second, has two frames then


@dataclass(frozen=True)
class Analysis:
    """Result of an analysis: the character's movement and its contacts.

    unseen: what was found where something unseen carries the body, one for each interval of the
    schedule; of feet that slide steadily one for all. After that, no more than hints, where the
    weight is beside what touches.
    """

    performance: Performance
    schedule: ContactSchedule
    unseen: tuple[CarriedBy, ...] = ()


def analyse(recording: Recording, problem: MotionProblem) -> Analysis:
    """Character and contacts in the problem's frames of a recording.

    Frames beyond these tell of contacts that they cut off, and of accelerations near their ends.

    Raises as `build_figure` does, and UnknownContactName, BadTiming; UnseenSupport and Treadmill
    where the problem refuses what they tell.
    """
    within, character = build_figure(recording, problem)
    performance = _performed(recording, within, character, problem.skin)
    # Before corrections, which are the last word, and name contacts as they are told.
    touching = find_contacts(performance, problem.scene)
    found = disjoint(parted(touching))
    skids = [each for each in found.unseen if each not in touching.unseen]
    found = replace(found, contacts=numbered(found.contacts))
    changed = disjoint(corrected(found, problem, performance))
    standing = foot_sized(changed, performance, problem.scene)
    schedule = grounded(standing, performance, problem.scene)
    known = performance.take
    unseen = unseen_support(
        schedule.contacts,
        schedule.duration,
        known.times,
        known.com,
        skids,
        falls_beside_unseen(touching),
    )
    schedule = replace(schedule, unseen=unseen)
    told = tuple(unseen_carriers(performance, schedule, skids))
    if told and problem.unseen is Unseen.REFUSE:
        raise told[0]
    return Analysis(performance, schedule, (*told, *weight_beside(performance, schedule)))


def _performed(
    recording: Recording, within: Recording, character: Character, skin: Skin | None
) -> Performance:
    """The performance in a range of a recording, with what is known of the frames beyond."""
    performance, take = perform(within, character, skin), take_of(recording, within)
    if len(take.frames) > len(within.frames):
        performance = replace(performance, longer=perform(take, character, skin))
    return performance


def part_of(analysis: Analysis, start: float, end: float) -> Analysis:
    """An analysis from one instant of its recording to another, s, both within ground phases.

    The figure and the contacts stay what they are in the whole; no frame need be at the instants.
    """
    whole, schedule = analysis.performance, analysis.schedule
    times, frames = whole.times, whole.recording.frames
    some = np.flatnonzero((times >= start) & (times <= end))
    within = whole.recording.window(float(frames[some[0]]), float(frames[some[-1]]))
    performance = _performed(whole.take.recording, within, whole.character, whole.skin)
    return Analysis(performance, schedule.part(float(times[some[0]]), float(times[some[-1]])))


def build_figure(recording: Recording, problem: MotionProblem) -> tuple[Recording, Character]:
    """The problem's frames of a recording, and the character built from them.

    Raises FramesReversed, ClipTooShort, FramesFarApart, MissingPart, ZeroLengthBone.
    """
    whole, ends = recording, problem.frames
    recording = chosen_frames(recording, problem)
    seconds = float(recording.times[-1]) if len(recording.times) else 0.0
    if seconds < MIN_CLIP_DURATION:
        chosen = len(recording.frames) < len(whole.frames)
        raise ClipTooShort(seconds, MIN_CLIP_DURATION, ends or whole.ends, chosen)
    require_dense(recording, MAX_FRAME_TIME)
    character = build_character(
        recording, mass=problem.mass, table=problem.mass_table, chosen=problem.bones
    )
    return recording, character


def chosen_frames(recording: Recording, problem: MotionProblem) -> Recording:
    """The problem's frames of a recording; all where it chooses none. Raises FramesReversed."""
    if problem.frames is None:
        return recording
    first, last = problem.frames
    if last < first:
        raise FramesReversed(first, last)
    return recording.window(first, last)


def require_dense(recording: Recording, longest: float) -> None:
    """Work grows with a clip's seconds, and frames so rare tell nothing. longest: s from one frame
    to the next. Raises FramesFarApart."""
    apart = 1.0 / recording.rate
    if apart > longest * (1.0 + ROUNDING):
        raise FramesFarApart(apart, longest)
