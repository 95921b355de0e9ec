"""The command `doctor`: what is wrong with a clip, and a recipe that repairs it."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ...bridge.recipe.problem import Recipe
from ...bridge.recipe.recording import FILE, RECORDING
from ...bridge.recipe_syntax.toml_text import entries, sections
from ...solver.data.problem import MotionProblem
from ...solver.data.reports.recording import Origin
from ...solver.doctor.examination.diagnose import Diagnosis, diagnose
from ...solver.doctor.examination.suspects import stated_contacts
from ...solver.doctor.falls import Spans
from ...solver.doctor.finding import Finding
from ...solver.doctor.repairs import filled_frame, recorded_frame
from ...solver.doctor.stretch import Span
from ..files.outbox import write_new
from ..words.analysis_text import relative
from ..words.doctor_text import diagnosis_text, finding_sentence, rounded
from ..words.doubt_text import file_doubts
from ..words.report_text import guesses
from .clip import Clip, read_clip


@dataclass(frozen=True)
class Examination:
    """The diagnosis of a clip, and how its file was read.

    problem: as it was asked for, with the first and last frame of those that were examined where
    some were chosen. mass: kg, None where the artist stated none.
    """

    diagnosis: Diagnosis
    origin: Origin
    clip: Clip
    problem: MotionProblem
    mass: float | None


def examined(
    clip: Clip, problem: MotionProblem, mass: float | None, carried: Spans = ()
) -> Examination:
    """mass: kg, None where the artist stated none. carried: recorded frames in which contacts
    touch that are stated. Raises Fault."""
    recording, whole, origin = read_clip(clip, problem)
    diagnosis = diagnose(recording, problem.bones, mass, carried=carried)
    diagnosis = diagnosis.counted_in(whole, recording.ends)
    problem = replace(problem, frames=problem.frames and recording.ends)
    return Examination(diagnosis, origin, clip, problem, mass)


def touched(recipe: Recipe) -> Spans:
    """Recorded frames of the contacts that a recipe states, which counts them in what its own
    repairs fill."""
    missing = recipe.repairs.missing if recipe.repairs else ()
    spans = stated_contacts(recipe.problem)
    return tuple((recorded_frame(a, missing), recorded_frame(b, missing)) for a, b in spans)


def told(examination: Examination, *, as_json: bool) -> str:
    """The diagnosis, what was guessed of the file, and doubts about it, as text."""
    diagnosis, origin = examination.diagnosis, examination.origin
    doubts, guessed = file_doubts(origin), guesses(origin)
    if not as_json:
        notes = [*doubts, f"guessed: {' and '.join(guessed)}"] if guessed else doubts
        return "".join(f"note: {note}.\n" for note in notes) + diagnosis_text(diagnosis)
    content = {
        "clip": origin.clip,
        "file": doubts,
        "guessed": guessed,
        "findings": [_content(finding) for finding in diagnosis.findings],
        "recording": RECORDING.write(rounded(diagnosis.repairs)),
        "mass": diagnosis.mass,
    }
    return json.dumps(content, indent=1, ensure_ascii=False) + "\n"


def write_recipe_of(examination: Examination, target: Path) -> None:
    """A new recipe with the repairs, and with what was stated for the diagnosis. Raises
    NotWrittenOver, OutputNotWritable."""
    diagnosis, problem = examination.diagnosis, examination.problem
    top = {
        "clip": relative(examination.clip.path, target),
        "frames": problem.frames and _kept(problem.frames, diagnosis),
        "mass": round(diagnosis.mass) if diagnosis.mass else examination.mass,
        "height": problem.height,
    }
    tables = {
        "bones": dict(problem.bones),
        FILE.header: FILE.write(examination.clip.stated(target)),
        RECORDING.header: RECORDING.write(rounded(diagnosis.repairs)),
    }
    texts = [text for header, values in tables.items() for text in sections(header, values)]
    write_new(target, "\n".join([entries(top), *texts]))


def _kept(frames: Span, diagnosis: Diagnosis) -> Span:
    """Of chosen frames those that all remedies leave, counted with those that are put in."""
    first, last = max(frames[0], diagnosis.kept[0]), min(frames[1], diagnosis.kept[1])
    missing = diagnosis.repairs.missing
    return filled_frame(first, missing), filled_frame(last, missing)


def _content(finding: Finding) -> dict[str, Any]:
    remedies = {"remedy": finding.remedy, "alternative": finding.alternative}
    return {
        "kind": finding.kind.value,
        "note": finding.kind.note,
        "sentence": finding_sentence(finding),
        "amount": finding.amount,
        "unit": finding.unit,
        "frames": finding.frames,
        "part": finding.part,
        **{
            name: None if repairs is None else RECORDING.write(rounded(repairs))
            for name, repairs in remedies.items()
        },
    }
