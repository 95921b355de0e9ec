"""Answers requests, and keeps the last fits: an adaptation of the same performance starts there."""

import time
from collections import Counter, OrderedDict
from collections.abc import Callable
from dataclasses import dataclass, replace

from .adapt import Adaptation, adapt, unadapted
from .contacts import PhaseKind
from .digest import digest
from .faults import Fault, NoFit, NoSolution
from .fit import Fit, fit
from .messages import Adapted, Analysed, Answer, Failed, Kind, Progress, Request
from .problem import MotionProblem, travel_axes
from .projection import Step
from .report import Origin, report
from .requests import Requests
from .session import Analysis, analyse
from .stature import scaled_problem, scaled_recording, scaled_schedule, scaled_track
from .violations import most_telling

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


class Service:
    """One at a time, in the process that calls."""

    def __init__(self) -> None:
        self._fits: OrderedDict[tuple[str, str], Fit] = OrderedDict()

    def answer(self, request: Request, tell: Tell) -> Answer:
        """Meets a request, telling each step; what an artist can mend comes back as Failed."""
        try:
            measured = _measure(request)
            if request.kind is Kind.ANALYSE:
                return _analysed(request, measured)
            return self._adapted(request, measured, tell)
        except Fault as fault:
            return Failed(request.id, fault)

    def _adapted(self, request: Request, measured: _Measured, tell: Tell) -> Adapted:
        progress = _stepper(request.id, tell)
        began = time.perf_counter()
        fitted = self._fit(request, measured.analysis, progress)
        if not fitted.solved:
            raise _unsolved(NoFit, unadapted(fitted), MotionProblem())
        fitted_at = time.perf_counter()
        adaptation = adapt(fitted, measured.problem, progress=progress)
        adapted_at = time.perf_counter()
        if not adaptation.solved:
            raise _unsolved(NoSolution, adaptation, measured.problem)
        track = adaptation.track
        content = report(adaptation, measured.problem, Origin(request.recording.name))
        content["stages"] = [
            {"name": "Fitting the physics", "seconds": fitted_at - began},
            {"name": "Adapting", "seconds": adapted_at - fitted_at},
        ]
        back = 1.0 / measured.factor
        return Adapted(
            request.id,
            scaled_track(track, back),
            content,
            scaled_schedule(adaptation.plan.schedule, back),
        )

    def _fit(self, request: Request, analysis: Analysis, progress: Callable[[Step], None]) -> Fit:
        """The stored fit of this performance, or a new one, which is then stored."""
        key = (digest(request.recording), _fit_relevant(request.problem))
        found = self._fits.pop(key, None)
        if found is None:
            found = fit(analysis.performance, analysis.schedule, progress=progress)
        self._fits[key] = found
        while len(self._fits) > MOST_FITS:
            self._fits.popitem(last=False)
        return found


def _measure(request: Request) -> _Measured:
    problem = request.problem
    analysis = analyse(request.recording, problem)
    height = analysis.performance.character.height
    if problem.height is None:
        return _Measured(analysis, problem, height, 1.0)
    factor = problem.height / height
    problem = scaled_problem(problem, factor)
    analysis = analyse(scaled_recording(request.recording, factor), problem)
    return _Measured(analysis, problem, height, factor)


def _analysed(request: Request, measured: _Measured) -> Analysed:
    schedule, performance = measured.analysis.schedule, measured.analysis.performance
    ground = [p for p in schedule.phases if p.kind is PhaseKind.GROUND]
    axes = {p.name: travel_axes(performance, schedule, p) for p in ground}
    back = 1.0 / measured.factor
    return Analysed(request.id, scaled_schedule(schedule, back), measured.height, axes)


def _fit_relevant(problem: MotionProblem) -> str:
    """Everything of a problem but its pins and requests, which the fit does not know."""
    bones = dict(sorted(problem.bones.items()))
    return repr(replace(problem, pins=(), requests=Requests(), bones=bones))


def _stepper(request: int, tell: Tell) -> Callable[[Step], None]:
    counts: Counter[str] = Counter()

    def progress(step: Step) -> None:
        counts[step.stage] += 1
        tell(Progress(request, step.stage, counts[step.stage], step.violation))

    return progress


def _unsolved(kind: type[NoSolution], adaptation: Adaptation, problem: MotionProblem) -> NoSolution:
    worst = most_telling(adaptation, problem)
    return kind(adaptation.outcome.status.value, worst, adaptation.reached)
