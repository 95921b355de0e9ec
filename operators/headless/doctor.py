"""The command `doctor`: what is wrong with a clip, and a recipe that repairs it."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...bridge.recipe.recording import RECORDING
from ...bridge.recipe_syntax.toml_text import entries, sections
from ...solver.data.problem import MotionProblem
from ...solver.data.reports.recording import Origin
from ...solver.doctor.examination.diagnose import Diagnosis, diagnose
from ...solver.doctor.finding import Finding
from ...solver.doctor.repairs import filled_frame
from ...solver.doctor.stretch import Span
from ..words.analysis_text import relative
from ..words.doctor_text import diagnosis_text, finding_sentence, rounded
from ..words.doubt_text import file_doubts
from ..words.report_text import guesses
from .clip import Clip, read_clip
from .outbox import not_writable


@dataclass(frozen=True)
class Examination:
    """The diagnosis of a clip, and how its file was read.

    frames: first and last one that were examined; None where none were chosen.
    """

    diagnosis: Diagnosis
    origin: Origin
    frames: Span | None


def examined(clip: Clip, problem: MotionProblem, mass: float | None) -> Examination:
    """mass: kg, None where the artist stated none. Raises Fault."""
    recording, whole, origin = read_clip(clip, problem)
    diagnosis = diagnose(recording, problem.bones, mass).counted_in(whole, recording.ends)
    return Examination(diagnosis, origin, problem.frames and recording.ends)


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


def write_recipe_of(examination: Examination, clip: Clip, target: Path) -> None:
    """A new recipe with the repairs. Raises OutputNotWritable."""
    diagnosis = examination.diagnosis
    top = {
        "clip": relative(clip.path, target),
        "frames": examination.frames and _kept(examination.frames, diagnosis),
        "mass": diagnosis.mass and round(diagnosis.mass),
    }
    repairs = RECORDING.write(rounded(diagnosis.repairs))
    text = "\n".join([entries(top), *sections(RECORDING.header, repairs)])
    try:
        with target.open("x", encoding="utf-8") as file:
            file.write(text)
    except OSError as error:
        raise not_writable(target, error) from error


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
