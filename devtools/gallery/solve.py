"""The process that only solves: every solution of one result, then what MuJoCo makes of it."""

import sys
import time
from dataclasses import replace
from pathlib import Path
from statistics import median

from ...solver.analysis.analyse import analyse
from ...solver.data.problem import MotionProblem
from ...solver.data.requests import Method
from ...solver.results.npz_export import save
from ...solver.results.report import Origin, report
from ...solver.stages.fit import Fit, fit
from ...solver.stages.implicit import Adaptation, adapt
from .jobs import Json, Result, dump, load, undump, write_json

RUNS = 3  # of the quick solution; the median counts


def main(argv: list[str]) -> int:
    name, folder = argv[0], Path(argv[1])
    methods = tuple(Method)[:1] if "--quick" in argv else tuple(Method)
    result = load(name)
    recording = undump(folder / "recording.pickle")
    analysis = analyse(recording, result.problem)
    began = time.perf_counter()
    fitted = fit(analysis.performance, analysis.schedule)
    found: Json = {"fit": _solved(fitted, time.perf_counter() - began), "methods": {}}
    if not fitted.solved:
        write_json(found, folder / "measured.json")
        return 1
    _ = fitted.metric, fitted.torque_metric  # parts of the stored fit
    adaptation = solve(result, fitted, methods, found, folder)
    measure(result, adaptation, found, folder)
    return 0


def solve(
    result: Result, fitted: Fit, methods: tuple[Method, ...], found: Json, folder: Path
) -> Adaptation:
    """Every solution in turn, each written down as soon as it ends; the implicit one."""
    first: Adaptation | None = None
    for method in methods:
        problem = _by(result.problem, method)
        seconds, memory = [], 0.0
        for _ in range(RUNS if method is Method.IMPLICIT else 1):
            began = time.perf_counter()
            adaptation = adapt(fitted, problem)
            seconds.append(time.perf_counter() - began)
            memory = memory or peak_memory()  # once: repeating is for the clock alone
            if seconds[0] > 5.0:
                break
        solved = _solved(adaptation, median(seconds)) | {"peak_memory_gb": memory}
        found["methods"][method.value] = solved
        first = first or adaptation
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


def measure(result: Result, adaptation: Adaptation, found: Json, folder: Path) -> None:
    """Everything that needs no Blender; MuJoCo is loaded now that the memory is known."""
    from ...operators.headless.annotate import marks_of
    from ...operators.headless.picture import adapted_row
    from .checks import checks
    from .measure import measured

    found |= measured(adaptation)
    write_json(found, folder / "measured.json")
    write_json(report(adaptation, result.problem, Origin(result.clip.name)), folder / "report.json")
    save(adaptation.motion, folder / "trajectory.npz")
    marks = marks_of(adaptation, result.problem)
    travel = adaptation.fit.performance.com[[0, -1], :2]
    drawn = {
        "heading": tuple((travel[1] - travel[0]).tolist()),  # which all results of a clip share
        "row": adapted_row(adaptation, result.heading, marks),
        "track": adaptation.track,
        "recording": adaptation.setup.recording,
        "checks": checks(adaptation),
    }
    dump(drawn, folder / "drawn.pickle")
