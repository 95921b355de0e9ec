"""The process that makes the edits of one recording: arguments are its file, the folder of the
results, and the edits' names."""

import time
from collections.abc import Iterator, Sequence
from pathlib import Path

from ...operators.words.headline import headline, nearness
from ...operators.words.messages import sentence
from ...solver.data.faults import BadRecipe, Fault
from ...solver.data.recording import Recording
from ...solver.data.reports.recording import Origin
from ...solver.data.status import Status
from ...solver.fitting.fit import Fit
from ...solver.worker.pipeline import AdaptationResult, adapt_fit, fit_subject, no_fit
from ...solver.worker.stage_clock import StageClock
from ..processes import dump
from ..recordings import read
from .result import EditEnding, EditResult
from .windows import LEAST_FLIGHT, LacksPart, Window, jumps, window

RESULTS = "results.pickle"
FIT = "fit"


def main(argv: list[str]) -> int:
    clip, folder, names = Path(argv[0]), Path(argv[1]), argv[2:]
    found: list[EditResult] = []
    for result in survey(clip.stem, read(clip), names):
        found.append(result)
        dump(found, folder / RESULTS)
    return 0


def survey(name: str, recording: Recording, edits: Sequence[str]) -> Iterator[EditResult]:
    """Of each jump the fit, and where there is one its edits."""
    whole = recording.ends
    try:
        found = jumps(recording)
    except Fault as fault:
        yield refused(name, whole, fault)
        return
    if not found:
        said = f"Nothing flies in it for {LEAST_FLIGHT:g} s or more."
        yield EditResult(name, whole, FIT, EditEnding.SKIPPED, 0.0, 0, said)
    for frames in found:
        try:
            if (jump := window(recording, frames)) is None:
                continue
            began = time.process_time()
            fitted = fit_subject(jump.subject, StageClock())
            _ = fitted.metric  # part of the stored fit
            seconds = time.process_time() - began
        except Fault as fault:
            yield refused(name, frames, fault)
            continue
        ending, said = EditEnding.SOLVED, ""
        if not fitted.solved:
            ending, said = EditEnding.MISSED, sentence(no_fit(jump.subject, fitted))
        steps = sum(len(outcome.steps) for outcome in fitted.outcomes)
        yield EditResult(name, frames, FIT, ending, seconds, steps, said)
        if fitted.solved:
            yield from (edited(name, jump, fitted, edit) for edit in edits)


def refused(name: str, frames: tuple[float, float], fault: Fault) -> EditResult:
    """Of frames that are not even fitted."""
    return EditResult(name, frames, FIT, EditEnding.IMPOSSIBLE, 0.0, 0, sentence(fault))


def edited(recording: str, window: Window, fitted: Fit, name: str) -> EditResult:
    """One edit, whatever becomes of it."""
    began, steps = time.process_time(), 0
    try:
        asked = window.subject.asked(window.problem(name))
        result = adapt_fit(asked, fitted, StageClock())
        steps = sum(len(outcome.steps) for outcome in result.adaptation.outcomes)
        ending, said = judged(result)
    except LacksPart as lack:
        ending, said = EditEnding.SKIPPED, str(lack)
    except BadRecipe as fault:  # ours
        ending, said = EditEnding.CRASHED, sentence(fault)
    except Fault as fault:
        ending, said = EditEnding.IMPOSSIBLE, sentence(fault)
    except Exception as problem:  # noqa: BLE001 - whatever it is, it is what is sought
        ending, said = EditEnding.CRASHED, f"{type(problem).__name__}: {problem}"
    seconds = time.process_time() - began
    return EditResult(recording, window.frames, name, ending, seconds, steps, said)


def judged(result: AdaptationResult) -> tuple[EditEnding, str]:
    """How a solve ended, and the words for it."""
    if result.fault is None:
        report = result.report(Origin(result.recording.name))
        lines = map(str.strip, headline(report))
        near = nearness(report.fit_to_recording)  # of all edits the same
        return EditEnding.SOLVED, " | ".join(line for line in lines if line != near)
    no_body = result.adaptation.outcome.status is Status.NO_BODY
    return EditEnding.IMPOSSIBLE if no_body else EditEnding.MISSED, sentence(result.fault)
