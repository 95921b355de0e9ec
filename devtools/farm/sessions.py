"""A batch in a session of Open Job Description, as its own program runs one."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

from ...batch.farm.jobs import openjd_parameters
from ...solver.one_thread import ONE_THREAD
from ..environment.virtual_environment import ROOT
from .installed import program_in

TEMPLATE = ROOT / "farm" / "openjd" / "hangtime_batch.yaml"


def run_session(folder: Path, package: Path, cells_per_task: int) -> str:
    """Run a planned batch, and its collecting; what the session says. Raises CalledProcessError."""
    parameters = openjd_parameters(folder, cells_per_task)
    parameters["Program"] = str(program_in(package))
    command = [sys.executable, "-m", "openjd", "run", str(TEMPLATE), "--step", "Collect"]
    command += ["--run-dependencies", "--job-param", json.dumps(parameters)]
    variables = os.environ | {"PYTHONPATH": str(package)} | ONE_THREAD
    return subprocess.run(
        command,
        env=variables,
        check=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    ).stdout
