"""The process of one trial: reads, fits, compares; leaves DIR/NAME.json."""

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

from ...operators.words.messages import sentence
from ...solver.data.faults import Fault
from .fitted import fit_trial, ground_forces
from .forces import rms_errors
from .trials import Trial, read

Json = dict[str, Any]


def main(argv: list[str]) -> int:
    folder, name, out = Path(argv[0]), argv[1], Path(argv[2])
    trial = read(folder, name)
    row: Json = {"trial": name, "kind": trial.facts["kind"]}
    try:
        row |= measured(trial)
    except Fault as fault:
        row["refused"] = sentence(fault)
    text = json.dumps(row, indent=1, ensure_ascii=False) + "\n"
    (out / f"{name}.json").write_text(text, encoding="utf-8")
    return 0


def measured(trial: Trial) -> Json:
    """Everything that is measured of one trial, as JSON. Raises what `fit_trial` does."""
    fitted = fit_trial(trial)
    ours = ground_forces(fitted)
    return {
        "seconds": fitted.seconds,
        "errors": [asdict(error) for error in rms_errors(trial, ours)],
    }
