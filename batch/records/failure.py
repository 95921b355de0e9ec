"""Results of cells whose process could not tell any."""

from __future__ import annotations

from pathlib import Path

from .manifest import read_plan
from .result import RESULT, CellResult, State, lasting_result, written_cell


def write_failure(folder: Path, cell: str, sentence: str) -> CellResult:
    """A cell's result that tells why it failed; or what another process has told of it meanwhile.
    Raises WrongManifest where the manifest has no such cell, FolderGone."""
    settings, plan = read_plan(folder, cell)
    clip, recipe = plan.names
    result = CellResult(
        cell=plan.cell,
        state=State.FAILED,
        clip=clip,
        recipe=recipe,
        version=settings.version,
        sentence=sentence,
        values=plan.values,
    )
    with written_cell(folder, cell) as aside:
        (aside / RESULT).write_text(result.as_json(), encoding="utf-8")
    return lasting_result(folder, cell) or result
