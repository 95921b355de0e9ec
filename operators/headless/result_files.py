"""Files of a result: their names, and those that need no Blender, trajectory and report; and the
lines that a terminal shows of it."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict
from itertools import product
from pathlib import Path
from types import MappingProxyType

from ...bridge.formats.paths import are_one_file
from ...bridge.recipe.export import ExportOptions
from ...solver.data.faults import CarriedBy, WouldReplaceInput
from ...solver.data.reports.report import Report, as_json
from ...solver.results.npz_export import save
from ...solver.results.unseen_support import hints_left
from ...solver.worker.pipeline import AdaptationResult
from ..files.outbox import Outbox, not_writable
from ..words.headline import headline
from ..words.messages import together
from ..words.report_text import as_text
from ..words.warning_text import warning_lines, warnings_of
from .explained import explained

EXPORTED = "adapted"  # file name without ending
SAVED = f"{EXPORTED}.blend"
BEST = "best_found.blend"
PICTURE, FILM = "sheet.png", "film.mp4"
TRAJECTORY = "trajectory.npz"
REPORTS = "report.json", "report.txt"  # for programs, for people
NAMES = (SAVED, BEST, PICTURE, FILM, TRAJECTORY, *REPORTS)  # of all but the exported file


def every_name() -> tuple[str, ...]:
    """The names that files of a job can have, whatever it is asked for."""
    from ...bridge.exports.engines import ENDINGS  # needs Blender

    return (*NAMES, *(f"{EXPORTED}{ending}" for ending in ENDINGS.values()))


def exported(folder: Path, export: ExportOptions) -> Path:
    """The file for others."""
    from ...bridge.exports.engines import ENDINGS, format_of

    return folder / f"{EXPORTED}{ENDINGS[format_of(export)]}"


def others(folder: Path, kept: Iterable[Path]) -> list[Path]:
    """The paths that files of a job can have, but for those of the files that are kept."""
    paths = [folder / name for name in every_name()]
    same = {path for path, each in product(paths, tuple(kept)) if are_one_file(path, each)}
    return [path for path in paths if path not in same]


def require_apart(inputs: Iterable[Path], folder: Path, export: ExportOptions) -> None:
    """Before a solve takes its seconds. inputs: what a job reads. Raises WouldReplaceInput."""
    for read, written in product(inputs, own_results(folder, export)):
        if are_one_file(read, written):
            raise WouldReplaceInput(str(written))


def own_results(folder: Path, export: ExportOptions) -> tuple[Path, ...]:
    """The files that a job writes; a film is a batch's."""
    return (exported(folder, export), *(folder / name for name in NAMES if name != FILM))


def write_trajectory(result: AdaptationResult, outbox: Outbox) -> None:
    """The motion as bodies and forces. Raises OutputNotWritable."""
    try:
        save(result.adaptation.motion, outbox.path(TRAJECTORY))
    except OSError as error:
        raise not_writable(outbox.folder / TRAJECTORY, error) from error


def write_report(
    report: Report,
    outbox: Outbox,
    more: Mapping[str, object] = MappingProxyType({}),
    last: Sequence[str] = (),
) -> None:
    """The report for programs and for people; the former lists the files that were written before
    it. more, and last lines: what is told beside it, in each.

    Raises OutputNotWritable.
    """
    outbox.write_text(
        REPORTS[1],
        "\n".join([as_text(report), *last, *([""] if last else [])]),
    )
    files = {name: asdict(record) for name, record in outbox.records().items()}
    records = {**as_json(report), "warnings": warnings_of(report), **more, "files": files}
    outbox.write_text(REPORTS[0], json.dumps(records, indent=1, allow_nan=False) + "\n")


def result_lines(
    result: AdaptationResult, report: Report, told: Sequence[CarriedBy]
) -> tuple[str, ...]:
    """The headline, warnings, and what is still true of what the analysis of the clip told of who
    carries the body: all of it where what was asked for was not found."""
    left = told
    if result.fault is None:
        left = hints_left(told, report, result.schedule, result.recording)
    advice = (explained(each, None) for each in together(left))
    return *headline(report), *warning_lines(report), *advice
