"""The process that only solves: every solution of one result, then its check by MuJoCo."""

import sys
from dataclasses import replace
from pathlib import Path
from statistics import median

from ...solver.data.problem import MotionProblem
from ...solver.data.reports.recording import Origin
from ...solver.data.reports.report import as_json
from ...solver.data.solver_options import Method
from ...solver.fitting.fit import Fit
from ...solver.results.npz_export import save
from ...solver.stages.implicit import Adaptation
from ...solver.worker.pipeline import AdaptationResult, Subject, adapt_fit, fit_subject, measure
from ...solver.worker.stage_clock import StageClock
from ..processes import dump, undump
from .jobs import Json, Result, load, write_json

RUNS = 3  # of the quick solution, whose time is asked for; the median counts


def main(argv: list[str]) -> int:
    name, folder, recording = argv[0], Path(argv[1]), Path(argv[2])
    methods = tuple(Method)[:1] if "--quick" in argv else tuple(Method)
    runs = 1 if "--once" in argv else RUNS
    result = load(name)
    subject = measure(undump(recording), result.problem)
    clock = StageClock()
    fitted = fit_subject(subject, clock)
    found: Json = {"fit": _solved(fitted, clock.done[-1].seconds), "methods": {}}
    if not fitted.solved:
        write_json(found, folder / "measured.json")
        return 1
    _ = fitted.metric, fitted.torque_metric  # parts of the stored fit
    adapted = adapt_by(methods, runs, result.problem, subject, fitted, found, folder)
    write_down(result, adapted, found, folder)
    return 0


def adapt_by(
    methods: tuple[Method, ...],
    runs: int,
    problem: MotionProblem,
    subject: Subject,
    fitted: Fit,
    found: Json,
    folder: Path,
) -> AdaptationResult:
    """Every solution in turn, each written down as soon as it ends; the first of them.

    runs: of the quick one.
    """
    first: AdaptationResult | None = None
    for method in methods:
        asked = subject.asked(_by(problem, method))
        seconds, memory = [], 0.0
        for _ in range(runs if method is Method.IMPLICIT else 1):
            clock = StageClock()
            result = adapt_fit(asked, fitted, clock)
            seconds.append(clock.done[-1].seconds)
            memory = memory or peak_memory()  # once: repeating is for the clock alone
            if seconds[0] > 5.0:
                break
        solved = _solved(result.adaptation, median(seconds)) | {"peak_memory_gb": memory}
        found["methods"][method.value] = solved
        first = first or result
        write_json(found, folder / "measured.json")
    assert first is not None
    return first


def _by(problem: MotionProblem, method: Method) -> MotionProblem:
    solution = replace(problem.requests.solution, method=method)
    return replace(problem, requests=replace(problem.requests, solution=solution))


def _solved(solved: Fit | Adaptation, seconds: float) -> Json:
    transcription = solved.motion.transcription
    unknowns = transcription.n_unknowns
    if isinstance(solved, Adaptation) and solved.setup.basis is not None:
        full, reduced = solved.setup.basis.shape
        unknowns -= (full - reduced) * transcription.basis.n_coefficients
    return {
        "status": solved.outcome.status.value,
        "solved": solved.solved,
        "seconds": seconds,
        "iterations": sum(len(outcome.steps) for outcome in solved.outcomes),
        "unknowns": unknowns,
        "rows": len(transcription.values(solved.motion.x, solved.motion.places)),
        "peak_memory_gb": peak_memory(),
    }


def peak_memory() -> float:
    """The most that this process has held so far, GB."""
    if sys.platform == "win32":
        return float("nan")  # nothing in the standard library tells
    import resource

    unit = 1.0 if sys.platform == "darwin" else 1024.0  # bytes, kilobytes
    return unit * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e9


def write_down(result: Result, adapted: AdaptationResult, found: Json, folder: Path) -> None:
    """Measures and writes what needs no Blender; MuJoCo is loaded now that the memory is known."""
    from ...operators.headless.annotate import marks_of
    from ...operators.headless.picture import adapted_row, heading
    from ..checks.penetrations import solid_check
    from .checks import checks
    from .measure import measured

    adaptation, track, subject = adapted.adaptation, adapted.track, adapted.subject
    found |= measured(adaptation)
    write_json(found, folder / "measured.json")
    write_json(as_json(adapted.report(Origin(result.clip.name))), folder / "report.json")
    save(adaptation.motion, folder / "trajectory.npz")
    marks = marks_of(adaptation, adapted.subject.problem)
    times = (track.frames - track.frames[0]) / subject.recording.rate
    drawn = {
        "heading": heading(adaptation),  # which all results of a clip share
        "row": adapted_row(adaptation, result.heading, marks),
        "track": track,
        "recording": adapted.recording,
        "checks": checks(adaptation),
        "solid": solid_check(adaptation, subject.problem, times, subject.factor),
    }
    dump(drawn, folder / "drawn.pickle")
