"""Commands for farms: one that a task of theirs runs, and one that writes their jobs."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable
from pathlib import Path

from .jobs import flamenco_job, openjd_parameters

JOBS = {"flamenco": flamenco_job, "openjd": openjd_parameters}
TASK, JOB = "task", "job"
DEFAULT_CELLS = 20  # that a task solves: the program then starts once for half a minute's work


def add_farm_commands(
    commands: argparse._SubParsersAction[argparse.ArgumentParser], count: Callable[[str], int]
) -> None:
    """Add them to a batch's commands. count: reads a number above zero."""
    task = commands.add_parser(TASK, help="solve some cells, as a task of a farm's job")
    task.set_defaults(act=FARM_ACTS[TASK])
    task.add_argument("folder", type=Path, metavar="DIR", help="the batch's folder")
    task.add_argument("cells", metavar="CELLS", help="their places in the manifest, as 1-10,12")
    job = commands.add_parser(JOB, help="print a farm's job for what is not solved yet, as JSON")
    job.set_defaults(act=FARM_ACTS[JOB])
    job.add_argument("farm", choices=sorted(JOBS), help="for whom")
    job.add_argument("folder", type=Path, metavar="DIR", help="the batch's folder")
    job.add_argument(
        "--cells-per-task",
        type=count,
        default=DEFAULT_CELLS,
        metavar="N",
        help=f"default: {DEFAULT_CELLS}",
    )


def task_of_farm(options: argparse.Namespace) -> int:
    """Solves a task's cells. Raises BatchFault."""
    from .task import run_task  # loads the solver

    return run_task(options.folder, options.cells, sys.stdout)


def job_for_farm(options: argparse.Namespace) -> int:
    """Prints a job. Raises BatchFault."""
    job = JOBS[options.farm](options.folder, options.cells_per_task)
    print(json.dumps(job, ensure_ascii=False, indent=1))
    return 0


FARM_ACTS: dict[str, Callable[[argparse.Namespace], int]] = {TASK: task_of_farm, JOB: job_for_farm}
