"""The manual's pictures of Blender's window, the scenarios that take them, and their renewal."""

from __future__ import annotations

import shutil
from pathlib import Path

from ...environment.virtual_environment import ROOT

IMAGES = ROOT / "docs/images/manual"
TAKEN = "manual"  # the folder of a run with the pictures
SCENARIOS = {
    "analyzed": "analyses",
    "constraints": "holds_constraints",
    "doubts": "shows_finding",
    "drag": "drags_landing",
    "examined": "examines",
    "failure": "tells_failure",
    "plots": "shows_plots",
    "repaired": "repairs_all",
    "report": "opens_report",
    "result": "shows_result",
    "timeline": "heightens_timeline",
    "world": "lands_on_crate",
}


def renew(out: Path) -> list[str]:
    """Puts the pictures of a run into the manual; the names of those that it did not take."""
    missing = []
    for name in SCENARIOS:
        taken = out / TAKEN / f"{name}.png"
        if taken.is_file():
            shutil.copyfile(taken, IMAGES / taken.name)
        else:
            missing.append(name)
    return missing
