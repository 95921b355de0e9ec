"""Reports of the command line warn of what the window warns of."""

import json
from dataclasses import replace
from pathlib import Path

from hangtime.operators.files.outbox import Outbox
from hangtime.operators.files.record import FileRecord
from hangtime.operators.headless.earlier import listed_files
from hangtime.operators.headless.result_files import write_report
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.data.reports.recording import Origin
from hangtime.solver.data.reports.report import Report
from hangtime.solver.results.report import report
from hangtime.solver.stages.implicit import adapt
from hangtime.tests.helpers.fitted_hop import fitted_hop


def hard(times: float) -> Report:
    """The hop as it was recorded, had the ground pushed that many times as hard."""
    made = report(adapt(fitted_hop(), MotionProblem()), MotionProblem(), Origin("hop"))
    peaks = tuple(replace(each, peak_bw=times * each.peak_bw) for each in made.forces.peaks)
    return replace(made, forces=replace(made.forces, peaks=peaks))


def written(made: Report, folder: Path) -> tuple[list[str], str]:
    """The warnings of report.json, and report.txt."""
    with Outbox(folder) as outbox:
        write_report(made, outbox)
        outbox.deliver()
    told = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    return told["warnings"], (folder / "report.txt").read_text(encoding="utf-8")


def test_a_landing_harder_than_anyones_is_warned_of_in_both_reports(tmp_path: Path) -> None:
    (warning,), text = written(hard(5.0), tmp_path)
    assert warning.startswith("The ground pushes with ")
    assert text.count(f"\nWarning: {warning}\n") == 1


def test_of_a_motion_as_recorded_nothing_is_warned(tmp_path: Path) -> None:
    warnings, text = written(hard(1.0), tmp_path)
    assert warnings == []
    assert "Warning" not in text


def test_the_report_lists_the_files_that_are_written_with_it(tmp_path: Path) -> None:
    with Outbox(tmp_path) as outbox:
        outbox.write_text("trajectory.npz", "a motion")
        write_report(hard(1.0), outbox)
        outbox.deliver()
    listed = listed_files(tmp_path)
    assert set(listed) == {"trajectory.npz", "report.txt"}
    assert all(FileRecord.of(tmp_path / name) == record for name, record in listed.items())
