"""The template for Open Job Description, checked and run by its own program."""

import json
import os
import subprocess
import sys
from pathlib import Path

from hangtime.batch.farm.jobs import flamenco_job, openjd_parameters
from hangtime.devtools.farm.plans import contents, differing, half_written, plan_hops
from hangtime.devtools.farm.sessions import TEMPLATE, run_session

OPENJD = [sys.executable, "-m", "openjd"]


def test_the_template_is_valid() -> None:
    done = subprocess.run([*OPENJD, "check", str(TEMPLATE)], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_session_solves_all_cells_and_collects(
    tmp_path: Path, package: Path, solved: dict[str, str]
) -> None:
    folder = tmp_path / "Sprünge 1"
    manifest = plan_hops(folder, 12)
    told = run_session(folder, package, cells_per_task=5)
    assert "Session ended successfully" in told
    assert told.count("Parameter values") >= 3  # chunks of 5, 5 and 2
    assert differing(contents(folder, manifest), solved) == []
    assert half_written(folder) == []
    assert (folder / "table.csv").is_file()


def test_jobs_name_the_cells_without_a_result(tmp_path: Path) -> None:
    folder = tmp_path / "jumps"
    manifest = plan_hops(folder, 5)
    home = folder / "cells" / manifest.cells[1].cell
    home.mkdir(parents=True)
    cell = manifest.cells[1]
    result = {
        **{"cell": cell.cell, "state": "no solution", "clip": "a", "recipe": "b"},
        **{"version": "1", "exit_code": 3, "headline": [], "files": []},
    }
    (home / "result.json").write_text(json.dumps(result))
    job = flamenco_job(folder, 2)
    assert job["settings"] == {
        "batch_folder": folder.as_posix(),
        "cells": "1,3-5",
        "cells_per_task": 2,
    }
    assert job["type"] == "hangtime-batch"
    assert openjd_parameters(folder, 2)["Cells"] == "1,3-5"


def test_the_command_of_the_wheel_tells_what_is_no_batch(tmp_path: Path, package: Path) -> None:
    program = "import sys; from hangtime.batch.cli import main; sys.exit(main())"
    done = subprocess.run(
        [sys.executable, "-c", program, "task", str(tmp_path), "1"],
        capture_output=True,
        text=True,
        env=os.environ | {"PYTHONPATH": str(package)},
    )
    assert done.returncode == 2
    assert "check the folder, or plan a batch into it" in done.stderr
