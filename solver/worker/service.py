"""Answers requests, and remembers the last fits, from which adaptations of them start."""

from collections import Counter
from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial

from ..analysis.performance import perform
from ..analysis.pins.pinned_places import backward_stances, travel_axes
from ..body.character import build_character
from ..data.faults import Fault, computable
from ..data.problem import MotionProblem
from ..data.recording import Recording, digest
from ..data.reports.recording import Origin
from ..data.scene import SceneObject
from ..doctor.examination.diagnose import diagnose
from ..doctor.examination.ground import as_stood
from ..doctor.examination.repair import as_asked, unplaced, unplaced_skin
from ..doctor.examination.scales import odd_size
from ..doctor.examination.suspects import stated_contacts
from ..doctor.repairs import Repairs
from ..doctor.stance.feet import find_feet
from ..fitting.fit import Fit
from ..optimisation.sqp import Step, Stopped
from ..results.fit_quality import fit_quality
from ..results.unseen_support import fit_needs
from ..stages.implicit import Adaptation
from ..stages.interactive import Follower, change, pelvis_range
from ..transcription.motion import Motion
from .pipeline import ADAPTING, Subject, fit_possible, fit_subject, measure, no_fit, on_fit, solve
from .progress import ProgressFraction
from .protocol import (
    Adapted,
    Analysed,
    Answer,
    Cancelled,
    Ending,
    Examined,
    Failed,
    Fitted,
    Followed,
    Progress,
    Request,
    RequestKind,
)
from .recent_fits import RecentFits
from .stage_clock import StageClock

MOST_FITS = 3
EXAMINING = RequestKind.EXAMINE.value  # the one stage of an examination

Tell = Callable[[Progress], None]
_Key = tuple[str, str, tuple[SceneObject, ...]]  # of an analysis


class Cancel(Exception):
    """Ends a request that shall be dropped."""


@dataclass
class _Following:
    """A drag's fit, its pelvis's range and the follower, kept from update to update."""

    fit: Fit
    pelvis: tuple[float, float]
    follower: Follower


class Service:
    """One at a time, in the process that calls.

    ending: asked at every step how the request with an id shall end, None if it may go on.
    """

    def __init__(self, ending: Callable[[int], Ending | None] = lambda _: None) -> None:
        self._ending = ending
        self._fits = RecentFits(MOST_FITS)
        self._recording: Recording | None = None
        self._digest = ""  # of that: a drag asks about it with each update
        self._subject: tuple[_Key, Subject] | None = None
        self._last: tuple[Fit, MotionProblem, Adaptation] | None = None
        self._following: _Following | None = None

    def answer(self, request: Request, tell: Tell) -> Answer:
        """Meets a request, telling each step; a fault that the artist can mend is Failed."""
        try:
            return self._met(self._complete(request), tell)
        except Cancel:
            return Cancelled(request.id)
        except Fault as fault:
            return Failed(request.id, fault)

    def _complete(self, request: Request) -> Request:
        """With the last recording where the request brings none."""
        if request.recording is not None:
            self._recording, self._digest = request.recording, digest(request.recording)
        return replace(request, recording=self._recording)

    def _met(self, request: Request, tell: Tell) -> Answer:
        if request.kind is RequestKind.EXAMINE:
            return _examined(request, partial(self._told, request.id, tell))
        subject = self._subject_of(request)
        if request.kind is RequestKind.ANALYSE:
            return _analysed(request.id, subject)
        watch = _Watch(request.id, tell, self._ending)
        if request.kind is RequestKind.ADAPT:
            return self._adapted(request.id, subject, watch)
        if request.kind is RequestKind.FOLLOW:
            subject = subject.edited()
        fitted = self._fit(subject, watch)
        if request.kind is RequestKind.FOLLOW and fitted.solved:
            return self._followed(request.id, subject, fitted)
        if not fitted.solved:
            raise no_fit(subject, fitted)
        traces = subject.motion_traces(fitted.motion, fitted.schedule, subject.shape_changes)
        seconds, needs = watch.done[-1].seconds, fit_needs(fitted)
        return Fitted(request.id, fit_quality(fitted), seconds, traces, needs)

    def _told(self, request: int, tell: Tell, share: float) -> None:
        """An examination has come so far."""
        if self._ending(request) is Ending.CANCEL:
            raise Cancel
        tell(Progress(request, EXAMINING, 0, 0.0, "", share))

    def _adapted(self, request: int, subject: Subject, watch: "_Watch") -> Adapted:
        result = solve(subject, watch, partial(self._fit, fitted_by=fit_possible))
        if result.fault is None:
            self._last = (result.adaptation.fit, subject.problem, result.adaptation)
        report = result.report(Origin(subject.recording.name), watch.done)
        traces = result.traces()
        return Adapted(
            request, result.track, report, result.schedule, traces, result.moved, result.fault
        )

    def _followed(self, request: int, subject: Subject, fitted: Fit) -> Followed:
        problem, following = on_fit(subject, fitted).problem, self._following
        if following is None or following.fit is not fitted:
            follower = Follower(fitted, problem, self._similar(fitted, problem))
            following = _Following(fitted, pelvis_range(fitted), follower)
            self._following = following
        follower = following.follower
        with computable():
            status = follower.follow(problem)
        motion, setup = follower.motion, follower.setup
        traces = subject.motion_traces(motion, setup.schedule, setup.changes, torques=False)
        summary = change(fitted, following.pelvis, setup, motion, traces)
        return Followed(request, traces, status, summary)

    def _similar(self, fitted: Fit, problem: MotionProblem) -> Adaptation | None:
        """The last adaptation, if it differs in nothing but where the pins are."""
        if self._last is None:
            return None
        fit, last, adaptation = self._last
        same = fit is fitted and replace(last, pins=()) == replace(problem, pins=())
        return adaptation if same else None

    def _subject_of(self, request: Request) -> Subject:
        """The analysis, kept for the next request about the same frames and contacts."""
        assert request.recording is not None
        asked = (self._digest, request.problem.known_to_fit())
        key = (*asked, self._explaining(request.problem.scene))
        if self._subject is None or self._subject[0] != key:
            subject = measure(request.recording, request.problem)
            self._subject = (key, subject)
            key = (*asked, self._explaining(request.problem.scene))
            self._subject = (key, subject)
        return self._subject[1].asked(request.problem)

    def _explaining(self, scene: tuple[SceneObject, ...]) -> tuple[SceneObject, ...]:
        """Of the scene what the last subject is on; all where something unseen carries it."""
        if self._subject is None:
            return ()
        subject = self._subject[1]
        return scene if subject.schedule.unseen else _named(subject.stood_on, scene)

    def _fit(
        self,
        subject: Subject,
        clock: StageClock,
        fitted_by: Callable[[Subject, StageClock], Fit] = fit_subject,
    ) -> Fit:
        """The remembered fit of this performance, or a new one, which is then remembered."""
        assert self._subject is not None
        frames = subject.recording.frames
        key = self._subject[0], (float(frames[0]), float(frames[-1]))
        return self._fits.of(key, clock, partial(fitted_by, subject, clock))


class _Watch(StageClock):
    """Observer of a request: tells every step, and ends the solve when that is asked for.

    A motion as it stands is worth taking once the adaptation has begun; before, the end waits.
    """

    def __init__(self, request: int, tell: Tell, ending: Callable[[int], Ending | None]) -> None:
        super().__init__()
        self._request, self._tell, self._ending = request, tell, ending
        self._counts: Counter[str] = Counter()
        self._fraction = ProgressFraction()
        self._stoppable = False

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        self._stoppable = name == ADAPTING
        with super().stage(name):
            yield

    def step(self, step: Step, motion: Motion) -> None:
        ending = self._ending(self._request)
        if ending is Ending.CANCEL:
            raise Cancel
        if ending is Ending.AS_IT_STANDS and self._stoppable:
            raise Stopped(motion)
        self._counts[step.stage] += 1
        share = self._fraction.step(step)
        count = self._counts[step.stage]
        news = (step.stage, count, step.violation, step.worst, share)
        self._tell(Progress(self._request, *news))


def _analysed(request: int, subject: Subject) -> Analysed:
    schedule, performance = subject.analysis.schedule, subject.analysis.performance
    return Analysed(
        request,
        subject.schedule,
        subject.height,
        {p.name: travel_axes(performance, schedule, p) for p in schedule.stances},
        {body.name: body.bone for body in performance.character.bodies},
        subject.recorded_traces(),
        subject.fleshed,
        subject.cycle,
        subject.analysis.unseen,
        backward_stances(performance, schedule),
        None
        if subject.problem.height is not None
        else odd_size(performance.recording, subject.height, subject.problem.bones),
    )


def _examined(request: Request, told: Callable[[float], None]) -> Examined:
    """The diagnosis of a recording as it was before all repairs, and its feet as they are read now.

    Raises ClipTooShort, MissingPart, ZeroLengthBone.
    """
    assert request.recording is not None
    problem, placed = request.problem, request.placed or Repairs()
    with computable():
        as_made = unplaced(request.recording, placed)
        skin = unplaced_skin(problem.skin, placed)
        diagnosis = diagnose(
            *(as_made, problem.bones, problem.mass, skin, problem.scene, told),
            carried=stated_contacts(problem),
        )
        now = as_asked(request.recording, problem)
        performance = perform(now, build_character(now, chosen=problem.bones), problem.skin)
        feet = find_feet(as_stood(performance, problem.scene))
    return Examined(request.id, diagnosis, feet)


def _named(names: Collection[str], scene: Sequence[SceneObject]) -> tuple[SceneObject, ...]:
    """The objects of these names, which the recording is on: of the scene these alone count."""
    return tuple(thing for thing in scene if thing.name in names)
