"""The process that fits one source and adapts it to each target's landing by each solution."""

from dataclasses import replace
from pathlib import Path

from ...solver.arrays import FloatArray
from ...solver.data.faults import Fault
from ...solver.data.problem import OffsetAxes, Pin
from ...solver.data.requests import Requests
from ...solver.data.solver_options import Method, ObjectiveKind, SolverOptions
from ...solver.fitting.fit import Fit
from ...solver.worker.pipeline import Subject, adapt_fit, fit_subject, measure
from ...solver.worker.stage_clock import StageClock
from ..processes import dump, undump
from .jobs import SolvedJump, SolvedSource, SourceTask
from .jump_frame import JumpFrame, jump_frame, landing_phase, longest_flight
from .jump_measures import jump_measures
from .phased_jump import motion_phases


def main(argv: list[str]) -> int:
    task = undump(Path(argv[0]))
    assert isinstance(task, SourceTask)
    dump(solve_source(task), Path(argv[1]))
    return 0


def solve_source(task: SourceTask) -> SolvedSource:
    """The source's fit and all its adaptations. Raises what `measure` does."""
    subject = measure(task.source.recording(), task.source.problem)
    frame = jump_frame(subject.analysis.performance, subject.schedule)
    flight, clock = longest_flight(subject.schedule), StageClock()
    fitted = fit_subject(subject, clock)
    phases = motion_phases(fitted.motion, flight, frame)
    measures = jump_measures(fitted.motion, flight, frame, float(frame.landing[0]))
    status, seconds = fitted.outcome.status.value, clock.done[-1].seconds
    done = SolvedJump(fitted.solved, status, seconds, phases, measures)
    if not fitted.solved:
        return SolvedSource(done, {})
    asked = [(target, solution) for target in task.offsets for solution in task.solutions]
    adapted = {
        (target, solution): adapt_to(subject, fitted, frame, task.offsets[target], solution)
        for target, solution in asked
    }
    return SolvedSource(done, adapted)


def adapt_to(
    subject: Subject, fitted: Fit, frame: JumpFrame, offset: FloatArray, solution: str
) -> SolvedJump | str:
    """The fit adapted to its landing moved by offset (3,) m, world; why not, where it is not.

    The result's flight is read from its own schedule: it may last longer.
    """
    flight = longest_flight(subject.schedule)
    moved = (float(offset[0]), float(offset[1]), float(offset[2]))
    phase = landing_phase(subject.schedule, flight)
    pin = Pin("landing", phase, offset=moved, axes=OffsetAxes.WORLD)
    requests = Requests(solution=solver_options(solution))
    problem = replace(subject.problem, pins=(pin,), requests=requests)
    clock = StageClock()
    try:
        result = adapt_fit(subject.asked(problem), fitted, clock)
    except (Fault, RuntimeError, ValueError) as fault:  # also of CasADi and numpy: others go on
        return f"{type(fault).__name__}: {fault}"
    motion = result.adaptation.motion
    now = next(p for p in result.schedule.phases if p.name == flight.name)
    return SolvedJump(
        result.fault is None,
        result.adaptation.outcome.status.value,
        clock.done[-1].seconds,
        motion_phases(motion, now, frame),
        jump_measures(motion, now, frame, float((frame.landing + offset @ frame.axes)[0])),
    )


def solver_options(solution: str) -> SolverOptions:
    """Options of a solution: a method's name, or objectives of the explicit one, joined by +.

    Raises ValueError.
    """
    if solution in [method.value for method in Method]:
        return SolverOptions(method=Method(solution))
    objectives = tuple((ObjectiveKind(word.strip()), 1.0) for word in solution.split("+"))
    return SolverOptions(method=Method.EXPLICIT, objectives=objectives)
