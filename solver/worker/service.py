"""Answers requests, and keeps the last fits: an adaptation of the same performance starts there."""

import time
from collections import Counter, OrderedDict
from collections.abc import Callable
from dataclasses import dataclass, replace

from ..analysis.analyse import Analysis, analyse, build_figure
from ..analysis.pinned_places import travel_axes
from ..body.inverse_dynamics import InverseDynamics
from ..data.contacts import ContactSchedule, PhaseKind
from ..data.digest import digest
from ..data.faults import Fault, NoFit, NoSolution
from ..data.problem import MotionProblem
from ..data.recording import Recording
from ..data.requests import Requests
from ..data.scaling import scaled_problem, scaled_recording, scaled_schedule, scaled_track
from ..data.traces import Traces, scaled_traces
from ..optimisation.sqp import Step, Stopped
from ..results.report import Origin, closeness, report
from ..results.trace_sampling import motion_traces, recorded_traces
from ..results.violations import most_telling
from ..stages.fit import Fit, fit
from ..stages.implicit import Adaptation, adapt, unadapted
from ..stages.interactive import Follower, change
from ..transcription.motion import Motion
from .progress import ProgressFraction
from .protocol import (
    Adapted,
    Analysed,
    Answer,
    Cancelled,
    Ending,
    Failed,
    Fitted,
    Followed,
    Kind,
    Progress,
    Request,
)

MOST_FITS = 3

Tell = Callable[[Progress], None]


@dataclass(frozen=True)
class _Measured:
    """An analysis in the lengths that the problem's height asks for.

    height: m, as recorded. factor: the figure's height over that one. problem: in its lengths.
    """

    analysis: Analysis
    problem: MotionProblem
    height: float
    factor: float

    @property
    def recording(self) -> Recording:
        return self.analysis.performance.recording


class Cancel(Exception):
    """The request that is under way shall be dropped."""


@dataclass
class _Following:
    """What a drag follows: the fit and all of the problem but the pins that are dragged."""

    fit: Fit
    follower: Follower


class Service:
    """One at a time, in the process that calls.

    ending: asked at every step how the request with an id shall end, None if it may go on.
    """

    def __init__(self, ending: Callable[[int], Ending | None] = lambda _: None) -> None:
        self._ending = ending
        self._fits: OrderedDict[tuple[str, str], Fit] = OrderedDict()
        self._recording: Recording | None = None
        self._measured: tuple[tuple[str, str], _Measured] | None = None
        self._last: tuple[Fit, MotionProblem, Adaptation] | None = None
        self._following: _Following | None = None

    def answer(self, request: Request, tell: Tell) -> Answer:
        """Meets a request, telling each step; what an artist can mend comes back as Failed."""
        try:
            return self._met(self._complete(request), tell)
        except Cancel:
            return Cancelled(request.id)
        except Fault as fault:
            return Failed(request.id, fault)

    def _complete(self, request: Request) -> Request:
        """With the last recording where the request brings none."""
        if request.recording is not None:
            self._recording = request.recording
        return replace(request, recording=self._recording)

    def _met(self, request: Request, tell: Tell) -> Answer:
        measured = self._measure(request)
        if request.kind is Kind.ANALYSE:
            return _analysed(request, measured)
        watch = _Watch(request.id, tell, self._ending)
        began = time.perf_counter()
        fitted = self._fit(measured, watch)
        seconds = time.perf_counter() - began
        if request.kind is Kind.FIT:
            if not fitted.solved:
                raise _unsolved(NoFit, unadapted(fitted), MotionProblem())
            seen = _seen(measured, fitted.motion, fitted.schedule, dynamics_of(fitted.motion))
            return Fitted(request.id, closeness(fitted), seconds, seen)
        if not fitted.solved:
            adaptation = unadapted(fitted)
            fault = _unsolved(NoFit, adaptation, MotionProblem())
            return _adapted(request.id, measured, adaptation, (seconds, 0.0), fault)
        if request.kind is Kind.FOLLOW:
            return self._followed(request.id, measured, fitted)
        return self._adapt(request.id, measured, fitted, watch, seconds)

    def _adapt(
        self, request: int, measured: _Measured, fitted: Fit, watch: "_Watch", fitting: float
    ) -> Adapted:
        began = time.perf_counter()
        watch.stoppable = True
        adaptation = adapt(fitted, measured.problem, progress=watch)
        seconds = (fitting, time.perf_counter() - began)
        fault = None
        if adaptation.solved:
            self._last = (fitted, measured.problem, adaptation)
        else:
            fault = _unsolved(NoSolution, adaptation, measured.problem)
        return _adapted(request, measured, adaptation, seconds, fault)

    def _followed(self, request: int, measured: _Measured, fitted: Fit) -> Followed:
        problem, following = measured.problem, self._following
        if following is None or following.fit is not fitted:
            following = _Following(
                fitted, Follower(fitted, problem, self._similar(fitted, problem))
            )
            self._following = following
        follower = following.follower
        course = follower.follow(problem)
        seen = _seen(measured, follower.motion, follower.setup.schedule, None)
        numbers = change(fitted, follower.setup, follower.motion, seen)
        return Followed(request, seen, course, numbers)

    def _similar(self, fitted: Fit, problem: MotionProblem) -> Adaptation | None:
        """The last adaptation, if it differs in nothing but where the pins are."""
        if self._last is None:
            return None
        fit, last, adaptation = self._last
        same = fit is fitted and replace(last, pins=()) == replace(problem, pins=())
        return adaptation if same else None

    def _measure(self, request: Request) -> _Measured:
        """The analysis, kept for the next request about the same frames and contacts."""
        assert request.recording is not None
        key = (digest(request.recording), _fit_relevant(request.problem))
        if self._measured is None or self._measured[0] != key:
            self._measured = (key, _measure(request.recording, request.problem))
        measured = self._measured[1]
        problem = request.problem
        if problem.height is not None:
            problem = scaled_problem(problem, measured.factor)
        return replace(measured, problem=problem)

    def _fit(self, measured: _Measured, progress: "_Watch") -> Fit:
        """The stored fit of this performance, or a new one, which is then stored."""
        assert self._measured is not None
        key, analysis = self._measured[0], measured.analysis
        found = self._fits.pop(key, None)
        if found is None:
            found = fit(analysis.performance, analysis.schedule, progress=progress)
        self._fits[key] = found
        while len(self._fits) > MOST_FITS:
            self._fits.popitem(last=False)
        return found


class _Watch:
    """Tells every step, and ends the solve when that is asked for.

    stoppable: whether a motion as it stands is worth taking; before, the end waits until one is.
    """

    def __init__(self, request: int, tell: Tell, ending: Callable[[int], Ending | None]) -> None:
        self._request, self._tell, self._ending = request, tell, ending
        self._counts: Counter[str] = Counter()
        self._advance = ProgressFraction()
        self.stoppable = False

    def __call__(self, step: Step, motion: Motion) -> None:
        ending = self._ending(self._request)
        if ending is Ending.CANCEL:
            raise Cancel
        if ending is Ending.AS_IT_STANDS and self.stoppable:
            raise Stopped(motion)
        self._counts[step.stage] += 1
        share = self._advance.step(step)
        count = self._counts[step.stage]
        news = (step.stage, count, step.violation, step.worst, share)
        self._tell(Progress(self._request, *news))


def _measure(recording: Recording, problem: MotionProblem) -> _Measured:
    if problem.height is None:
        analysis = analyse(recording, problem)
        return _Measured(analysis, problem, analysis.performance.character.height, 1.0)
    # Before any contact is sought: at a wrong scale none would be found.
    height = build_figure(recording, problem)[1].height
    factor = problem.height / height
    problem = scaled_problem(problem, factor)
    analysis = analyse(scaled_recording(recording, factor), problem)
    return _Measured(analysis, problem, height, factor)


def _analysed(request: Request, measured: _Measured) -> Analysed:
    schedule, performance = measured.analysis.schedule, measured.analysis.performance
    ground = [p for p in schedule.phases if p.kind is PhaseKind.GROUND]
    axes = {p.name: travel_axes(performance, schedule, p) for p in ground}
    back = 1.0 / measured.factor
    return Analysed(
        request.id,
        scaled_schedule(schedule, back),
        measured.height,
        axes,
        {body.name: body.bone for body in performance.character.bodies},
        scaled_traces(recorded_traces(performance), back),
    )


def _adapted(
    request: int,
    measured: _Measured,
    adaptation: Adaptation,
    seconds: tuple[float, float],
    fault: NoSolution | None,
) -> Adapted:
    content = report(adaptation, measured.problem, Origin(measured.recording.name))
    names = ("Fitting the physics", "Adapting")
    content["stages"] = [
        {"name": name, "seconds": spent} for name, spent in zip(names, seconds, strict=True)
    ]
    back, schedule = 1.0 / measured.factor, adaptation.setup.schedule
    return Adapted(
        request,
        scaled_track(adaptation.track, back),
        content,
        scaled_schedule(schedule, back),
        _seen(measured, adaptation.motion, schedule, dynamics_of(adaptation.motion)),
        fault,
    )


def dynamics_of(motion: Motion) -> InverseDynamics:
    """Of a motion's own character and points."""
    return InverseDynamics(motion.transcription.character, motion.transcription.points)


def _seen(
    measured: _Measured,
    motion: Motion,
    schedule: ContactSchedule,
    dynamics: InverseDynamics | None,
) -> Traces:
    """Traces in the recording's own lengths."""
    seen = motion_traces(motion, measured.recording, schedule, dynamics)
    return scaled_traces(seen, 1.0 / measured.factor)


def _fit_relevant(problem: MotionProblem) -> str:
    """Everything of a problem but its pins and requests, which the fit does not know."""
    bones = dict(sorted(problem.bones.items()))
    return repr(replace(problem, pins=(), requests=Requests(), bones=bones))


def _unsolved(kind: type[NoSolution], adaptation: Adaptation, problem: MotionProblem) -> NoSolution:
    worst = most_telling(adaptation, problem)
    return kind(adaptation.outcome.status.value, worst, adaptation.reached)
