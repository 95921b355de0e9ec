"""Which frames of a take are one cycle: those near the artist's, a period of the contacts apart.

The period is the median of the times after which heels and toes come down, and leave, again. Where
the cycle begins is the artist's choice; it moves only as far as it must for the same points to
stand at both ends, and clearly so.
"""

from collections import defaultdict
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from ..analysis.analyse import build_figure
from ..analysis.grounding import parted
from ..analysis.performance import Performance, contact_points, find_contacts, perform
from ..analysis.take import take_of
from ..arrays import FloatArray
from ..body.character import Character
from ..data.contacts import ContactSchedule
from ..data.faults import (
    CycleClimbs,
    CycleTurns,
    EndsTouchOtherwise,
    NothingRecurs,
    NotInLoop,
    Treadmill,
)
from ..data.loop import Cycle
from ..data.problem import MotionProblem
from ..data.recording import Recording
from ..scene.belt import belt_speed
from .repetition import repeated, repeating_range, without_held_ends

NEAR_PERIOD = 0.3  # of the asked duration, by which the period may differ from it
NEAR_START = 0.5  # of the period, by which the start may move
MARGIN = 0.02  # s, between the seam and the next landing or lift-off: spans need as much
MAX_TURN = np.radians(20.0)
MAX_CLIMB = 0.1  # m; floors are level, and captured runs bob by half of it from step to step


def find_cycle(recording: Recording, problem: MotionProblem) -> tuple[Cycle, Recording]:
    """The cycle nearest to the problem's frames, these themselves where they are one; and the
    recording that it is in, with itself before and after where it is known only by its ends.

    Raises NothingRecurs, EndsTouchOtherwise, Treadmill, CycleTurns, CycleClimbs, ClipTooShort,
    MissingPart, ZeroLengthBone.
    """
    within, character = build_figure(recording, problem)
    search = _Search(problem, character, problem.frames or within.ends, recording.ends)
    moving = without_held_ends(recording)
    if search.asked[0] < moving.frames[0] or moving.frames[-1] < search.asked[1]:
        return search.by_ends(moving) or search.by_contacts(recording, within)
    try:
        return search.by_contacts(recording, within)
    except (NothingRecurs, EndsTouchOtherwise):
        if found := search.by_ends(moving):
            return found
        raise


def check_loop(problem: MotionProblem) -> None:
    """What a loop cannot have: other times, or another figure. Raises NotInLoop."""
    requests = problem.requests
    if not problem.loop:
        return
    for what, asked in (
        ("a timing", requests.timings),
        ("a hold", requests.holds),
        ("limbs of other lengths", requests.body.limbs),
    ):
        if asked:
            raise NotInLoop(what)


@dataclass(frozen=True)
class _Seams:
    """Where a take of `schedule`, with `rate` frames a second, may be cut. Frames count from its
    first."""

    schedule: ContactSchedule
    rate: float

    def touching(self, frame: int) -> tuple[str, ...]:
        """Points on the ground."""
        t = frame / self.rate
        return tuple(sorted(c.point for c in self.schedule.contacts if c.start <= t < c.end))

    def clear(self, frame: int) -> bool:
        """Whether nothing lands or leaves beside it."""
        apart = np.abs(np.array(self.schedule.boundaries[1:-1]) - frame / self.rate)
        return bool((apart > MARGIN).all())

    def meet(self, first: int, last: int) -> bool:
        """Whether a cycle may begin and end there."""
        same = self.touching(first) == self.touching(last)
        return same and self.clear(first) and self.clear(last)

    def period(self, start: int, end: int) -> float | None:
        """The median of the times, s, after which points land or leave again that are about those
        of a cycle between two frames; None without any."""
        about = (end - start) / self.rate
        around = (start / self.rate - NEAR_START * about, end / self.rate + NEAR_START * about)
        events: defaultdict[tuple[str, bool], list[float]] = defaultdict(list)
        for contact in self.schedule.contacts:
            if max(0.0, around[0]) < contact.start < around[1]:
                events[contact.point, True].append(contact.start)
            if around[0] < contact.end < min(self.schedule.duration, around[1]):
                events[contact.point, False].append(contact.end)
        apart = [b - a for each in events.values() for a, b in combinations(sorted(each), 2)]
        near = [each for each in apart if abs(each - about) <= NEAR_PERIOD * about]
        return float(np.median(near)) if near else None


@dataclass(frozen=True)
class _Search:
    """What a cycle is sought near: first and last scene frame asked for; and those recorded."""

    problem: MotionProblem
    character: Character
    asked: tuple[float, float]
    recorded: tuple[float, float]

    def by_contacts(self, recording: Recording, within: Recording) -> tuple[Cycle, Recording]:
        """The cycle that contacts tell in a recording, which goes on beyond the range `within`."""
        take = take_of(recording, within)
        take = replace(take, times=take.times - take.times[0])
        return self.cycle(self._performed(take)), recording

    def by_ends(self, recording: Recording) -> tuple[Cycle, Recording] | None:
        """The cycle that a range is whose ends meet, and that range with itself before and after;
        None where there is none."""
        performance = self._performed(recording)
        ends = repeating_range(performance, self.asked, NEAR_PERIOD)
        if ends is None:
            return None
        first, last = ends
        _require_level(performance, first, last)
        travel = (performance.com[last] - performance.com[first]) * [1.0, 1.0, 0.0]
        endless = repeated(recording.part(slice(first, last + 1)), travel)
        return self.cycle(self._performed(endless), last - first), endless

    def _performed(self, recording: Recording) -> Performance:
        return perform(recording, self.character, self.problem.skin)

    def cycle(self, performance: Performance, known: int | None = None) -> Cycle:
        """The cycle in a performance. known: how many frames it has, where that is.

        Raises NothingRecurs, EndsTouchOtherwise, Treadmill, CycleTurns, CycleClimbs.
        """
        recording = performance.recording
        schedule = parted(find_contacts(performance, self.problem.scene))
        try:
            first, count = self._nearest(_Seams(schedule, recording.rate), recording.frames, known)
        except (NothingRecurs, EndsTouchOtherwise):
            points, _ = contact_points(performance)
            if speed := belt_speed(performance.times, points):
                raise Treadmill(speed) from None  # which is why no foot is seen to stand
            raise
        _require_level(performance, first, first + count)
        first_frame, last_frame = recording.frames[[first, first + count]].tolist()
        return Cycle((first_frame, last_frame), self.asked)

    def _nearest(self, seams: _Seams, frames: FloatArray, known: int | None) -> tuple[int, int]:
        """Index of the cycle's first frame in `frames`, and its number of frames."""
        start, end = (int(np.abs(frames - frame).argmin()) for frame in self.asked)
        period = seams.period(start, end) if known is None else known / seams.rate
        if period is None:
            raise NothingRecurs(*self.asked)
        whole = round(period * seams.rate)
        # What is a cycle already stays one: detection is no better than a frame.
        stays = known is None and abs(end - start - period * seams.rate) <= 1.0
        for count in dict.fromkeys([end - start, whole] if stays else [whole]):
            reach = range(max(0, start - round(NEAR_START * count)), len(frames) - count)
            near = (f for f in reach if f <= start + NEAR_START * count)
            found = [f for f in near if seams.meet(f, f + count)]
            if found:
                return min(found, key=lambda f: self._far(frames, f, count)), count
        at_ends = (seams.touching(f) for f in (start, min(start + whole, len(frames) - 1)))
        raise EndsTouchOtherwise(*self.asked, whole, *at_ends)

    def _far(self, frames: FloatArray, first: int, count: int) -> tuple[bool, float]:
        """How far a cycle is from what is asked for; any with a frame that is not recorded is
        farther than all others."""
        beyond = frames[first] < self.recorded[0] or frames[first + count] > self.recorded[1]
        return bool(beyond), abs(float(frames[first]) - self.asked[0])


def _require_level(performance: Performance, first: int, last: int) -> None:
    """Raises CycleTurns, CycleClimbs."""
    turn = performance.rotations[last, 0] @ performance.rotations[first, 0].T
    angle = float(np.arctan2(turn[1, 0] - turn[0, 1], turn[0, 0] + turn[1, 1]))
    if abs(angle) > MAX_TURN:
        raise CycleTurns(float(np.degrees(angle)))
    climb = float(performance.com[last, 2] - performance.com[first, 2])
    if abs(climb) > MAX_CLIMB:
        raise CycleClimbs(climb)
