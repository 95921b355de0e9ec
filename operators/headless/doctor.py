"""The command `doctor`: what is wrong with a clip, and a recipe that repairs it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from ...bridge.recipe.recording import RECORDING
from ...bridge.recipe_syntax.toml_text import entries, sections
from ...solver.data.problem import MotionProblem
from ...solver.data.reports.recording import Origin
from ...solver.doctor.examination.diagnose import Diagnosis, diagnose
from ...solver.doctor.finding import Finding
from ..words.analysis_text import relative
from ..words.doctor_text import diagnosis_text, finding_sentence, rounded
from ..words.doubt_text import file_doubts
from ..words.report_text import guesses
from .clip import Clip, read_clip
from .outbox import not_writable


def examined(clip: Clip, problem: MotionProblem, mass: float | None) -> tuple[Diagnosis, Origin]:
    """The diagnosis of a clip, and how its file was read. mass: kg, None where the artist stated
    none. Raises Fault."""
    recording, origin = read_clip(clip, problem)
    return diagnose(recording, problem.bones, mass), origin


def told(diagnosis: Diagnosis, origin: Origin, *, as_json: bool) -> str:
    """The diagnosis, what was guessed of the file, and doubts about it, as text."""
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


def write_recipe_of(diagnosis: Diagnosis, clip: Clip, target: Path) -> None:
    """A new recipe with the repairs. Raises OutputNotWritable."""
    top = {"clip": relative(clip.path, target), "mass": diagnosis.mass and round(diagnosis.mass)}
    repairs = RECORDING.write(rounded(diagnosis.repairs))
    text = "\n".join([entries(top), *sections(RECORDING.header, repairs)])
    try:
        with target.open("x", encoding="utf-8") as file:
            file.write(text)
    except OSError as error:
        raise not_writable(target, error) from error


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
