"""Jobs for engines of farms, over the cells of a planned batch that have no result yet."""

import sys
from pathlib import Path
from typing import Any

from ..records.faults import WrongPlan
from ..records.manifest import Manifest, read_manifest
from ..records.result import lasting_result
from .cell_range import range_text

PLATFORMS = {"win32": "windows"}  # as Flamenco calls them, where that is not as Python does
PRIORITY = 50  # what Flamenco's own jobs have


def flamenco_job(folder: Path, cells_per_task: int) -> dict[str, Any]:
    """What Flamenco's API takes at /api/v3/jobs, for the job type of farm/flamenco.

    Raises WrongPlan where all is done, and as `read_manifest`.
    """
    settings = {
        "batch_folder": folder.resolve().as_posix(),
        "cells": cells_without_result(folder),
        "cells_per_task": cells_per_task,
    }
    return {
        "name": f"Hangtime: {folder.resolve().name}",
        "type": "hangtime-batch",
        "priority": PRIORITY,
        "submitter_platform": PLATFORMS.get(sys.platform, sys.platform),
        "settings": settings,
        "metadata": {"project": folder.resolve().name},
    }


def openjd_parameters(folder: Path, cells_per_task: int) -> dict[str, Any]:
    """The parameters of the template in farm/openjd. Raises as `flamenco_job`."""
    return {
        "Batch": str(folder.resolve()),
        "Cells": cells_without_result(folder),
        "CellsPerTask": cells_per_task,
    }


def cells_without_result(folder: Path) -> str:
    """The range of cells that are still to be run. Raises WrongPlan where there are none."""
    manifest = read_manifest(folder)
    waiting = waiting_cells(folder, manifest)
    if not waiting:
        raise WrongPlan(f"All {len(manifest.cells)} cells of {folder} have results; collect them.")
    return range_text(waiting)


def waiting_cells(folder: Path, manifest: Manifest) -> list[int]:
    """Places in the manifest, from 1, of the cells that have no result but a failure."""
    results = (lasting_result(folder, plan.cell) for plan in manifest.cells)
    return [place for place, result in enumerate(results, start=1) if result is None]
