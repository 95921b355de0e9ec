"""The process that measures the cases of one fit: reads, solves, writes the action, looks at it."""

from pathlib import Path

import bpy

from ...bridge.armature.read import read_recording, record
from ...bridge.armature.write import write_action
from ...bridge.files.import_clip import import_clip
from ...bridge.files.reproportioned import build_reproportioned
from ...operators.terminal.quiet import quiet
from ...solver.data.faults import Fault
from ...solver.data.recording import BEYOND, Recording
from ...solver.fitting.fit import Fit
from ...solver.worker.pipeline import AdaptationResult, Subject, adapt_fit, fit_subject, measure
from ...solver.worker.stage_clock import StageClock
from ..checks.joint_ranges import worst_joint
from ..checks.mujoco_check import check_motion
from ..checks.penetrations import solid_check
from ..processes import dump, undump
from .cases import CASES, RESULTS, Case
from .result import CaseResult, Physics

SHORT = 1.5  # s; what takes less is timed more often
RUNS = 3  # of what is short


def main(argv: list[str]) -> int:
    folder, quick = Path(argv[0]), "--quick" in argv
    cases: tuple[Case, ...] = undump(folder / CASES)
    subject = measure(_recording(cases[0]), cases[0].problem)
    fitted = fit_subject(subject, StageClock())
    _ = fitted.metric  # part of the stored fit
    found: list[CaseResult] = []
    for case in cases:
        found.append(measured(case, subject, fitted, quick=quick))
        dump(found, folder / RESULTS)
    return 0


def measured(case: Case, subject: Subject, fitted: Fit, *, quick: bool) -> CaseResult:
    """Everything of one case."""
    try:
        result, seconds, free = timed(case, subject, fitted, 1 if quick else RUNS)
    except Fault as fault:
        return CaseResult(case.name, case.source, failed=f"{type(fault).__name__}: {fault}")
    adaptation, scale = result.adaptation, subject.factor
    shown = _written(case, result)
    residual, _ = check_motion(adaptation.motion)
    return CaseResult(
        case.name,
        case.source,
        solved=adaptation.solved,
        penetrations=solid_check(adaptation, subject.problem, shown.times, scale).worst(shown),
        joint=worst_joint(shown, subject.analysis.performance),
        physics=Physics(
            *(
                residual.rms(part, flying)
                for flying in (True, False)
                for part in ("force", "moment")
            )
        ),
        seconds=seconds,
        free_seconds=free,
    )


def timed(
    case: Case, subject: Subject, fitted: Fit, runs: int
) -> tuple[AdaptationResult, float, float]:
    """The solid result, and the least seconds with solids and without, which take turns.

    The first turn builds functions that the others find made; so a long case has a second one.
    """
    taken: dict[bool, list[float]] = {False: [], True: []}
    while True:
        for on in (False, True):
            clock = StageClock()
            result = adapt_fit(subject.asked(case.solid(on)), fitted, clock)
            taken[on].append(clock.done[-1].seconds)
        enough = runs if taken[False][0] < SHORT else min(runs, 2)
        if len(taken[True]) >= enough:
            return result, min(taken[True]), min(taken[False])


def _recording(case: Case) -> Recording:
    first, last = case.problem.frames or (None, None)
    return read_recording(_opened(case), first=first, last=last, beyond=BEYOND)


def _opened(case: Case) -> bpy.types.Object:
    """The clip's armature in a scene of its own."""
    with quiet():
        bpy.ops.wm.read_factory_settings(use_empty=True)
        return import_clip(case.clip).armature


def _written(case: Case, result: AdaptationResult) -> Recording:
    """What Blender shows of a result at every frame of its action."""
    armature, track = _opened(case), result.track
    if case.problem.requests.body.limbs:
        armature, track, _ = build_reproportioned(result.recording, track)
    write_action(armature, track, name=case.name)
    return record(armature, track.frames)
