"""Answers requests, and keeps the last fits: an adaptation of the same performance starts there."""

import hashlib
import time
from collections import Counter, OrderedDict
from collections.abc import Callable
from dataclasses import replace

from .adapt import adapt
from .contacts import PhaseKind
from .faults import Fault, NoSolution
from .fit import Fit, fit
from .messages import Adapted, Analysed, Answer, Failed, Kind, Progress, Request
from .problem import MotionProblem, travel_axes
from .projection import Outcome, Status, Step
from .recording import Recording
from .session import Analysis, analyse

MOST_FITS = 3

Tell = Callable[[Progress], None]


def digest(recording: Recording) -> str:
    """A name for a recording's whole content: bones, rest, frames, rate and poses."""
    content = hashlib.sha256(recording.name.encode())
    for bone in recording.bones:
        content.update(f"\0{bone.name}\0{bone.parent}".encode())
        for rest in (bone.head, bone.tail, bone.rotation):
            content.update(rest.tobytes())
    for samples in (recording.frames, recording.times, recording.heads, recording.rotations):
        content.update(samples.tobytes())
    return content.hexdigest()


class Service:
    """One at a time, in the process that calls."""

    def __init__(self) -> None:
        self._fits: OrderedDict[tuple[str, str], Fit] = OrderedDict()

    def answer(self, request: Request, tell: Tell) -> Answer:
        """Meets a request, telling each step; what an artist can mend comes back as Failed."""
        try:
            analysis = analyse(request.recording, request.problem)
            if request.kind is Kind.ANALYSE:
                return _analysed(request, analysis)
            return self._adapted(request, analysis, tell)
        except Fault as fault:
            return Failed(request.id, fault)

    def _adapted(self, request: Request, analysis: Analysis, tell: Tell) -> Adapted:
        progress = _stepper(request.id, tell)
        began = time.perf_counter()
        fitted = self._fit(request, analysis, progress)
        fit_s = time.perf_counter() - began
        adaptation = adapt(fitted, request.problem, progress=progress)
        adapt_s = time.perf_counter() - began - fit_s
        _require_solved(adaptation.outcome)
        motion = adaptation.motion
        report = {"status": adaptation.outcome.status.value, "fit_s": fit_s, "adapt_s": adapt_s}
        track = motion.track(analysis.performance.recording)
        return Adapted(request.id, track, report, fitted.schedule)

    def _fit(self, request: Request, analysis: Analysis, progress: Callable[[Step], None]) -> Fit:
        """The stored fit of this performance, or a new one, which is then stored."""
        key = (digest(request.recording), _fit_relevant(request.problem))
        found = self._fits.pop(key, None)
        if found is None:
            found = fit(analysis.performance, analysis.schedule, progress=progress)
            _require_solved(found.outcome)
        self._fits[key] = found
        while len(self._fits) > MOST_FITS:
            self._fits.popitem(last=False)
        return found


def _analysed(request: Request, analysis: Analysis) -> Analysed:
    schedule, performance = analysis.schedule, analysis.performance
    ground = [p for p in schedule.phases if p.kind is PhaseKind.GROUND]
    axes = {p.name: travel_axes(performance, schedule, p) for p in ground}
    return Analysed(request.id, schedule, performance.character.height, axes)


def _fit_relevant(problem: MotionProblem) -> str:
    """Everything of a problem but its pins, which the fit does not know."""
    bones = dict(sorted(problem.bones.items()))
    return repr(replace(problem, pins=(), bones=bones))


def _stepper(request: int, tell: Tell) -> Callable[[Step], None]:
    counts: Counter[str] = Counter()

    def progress(step: Step) -> None:
        counts[step.stage] += 1
        tell(Progress(request, step.stage, counts[step.stage], step.violation))

    return progress


def _require_solved(outcome: Outcome) -> None:
    if outcome.status is not Status.SOLVED:
        raise NoSolution(outcome.status.value)
