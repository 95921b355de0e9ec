"""Batches whose cells are cheap: what a cell does is said by its clip's text.

Run as a program this is a worker that solves such cells; with a folder, a run of its batch.

sleep SECONDS: as long as that; dies: ends its process; dies once: the first time; fault: has no
solution; crash: raises; worse: fails a line of the certificate. Each begin and end is a line in the
folder's "work.log".
"""

from __future__ import annotations

import os
import runpy
import sys
import tempfile
import time
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

ROOT = Path(__file__).resolve().parents[2]
WORK_LOG = "work.log"

if TYPE_CHECKING:
    from hangtime.batch.planning.plan import Planned


def command() -> list[str]:
    """That starts such a worker."""
    return [sys.executable, "-I", __file__]


def planned(folder: Path, texts: Mapping[str, str], recipe: str = "") -> Planned:
    """A batch in folder/"out" of clips with these texts."""
    from hangtime.batch.planning.plan import Asked, plan
    from hangtime.batch.records.manifest import BatchSettings

    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    (folder / "recipe.toml").write_text(recipe, encoding="utf-8")
    clips = [str(folder / name) for name in texts]
    asked = Asked(BatchSettings(), clips, [str(folder / "recipe.toml")])
    return plan(asked, folder / "out")


def run(folder: Path, jobs: int = 2, **more: Any) -> str:
    """Runs the batch in a folder; what it told."""
    import io
    from collections import Counter

    from hangtime.batch.records.manifest import read_manifest
    from hangtime.batch.running.progress import Progress
    from hangtime.batch.running.runner import LocalRun

    manifest, out = read_manifest(folder), io.StringIO()
    progress = Progress(out, len(manifest.cells), Counter())
    try:
        LocalRun(folder, manifest, jobs, command(), progress, **more).run()
    finally:
        print(out.getvalue())
    return out.getvalue()


def lines(folder: Path, word: str) -> list[str]:
    """The cells that began, or ended, in the order in which they did."""
    path = folder / WORK_LOG
    every = path.read_text().splitlines() if path.exists() else []
    return [line.split()[1] for line in every if line.startswith(f"{word} ")]


def _solver(folder: Path) -> Any:
    from hangtime.batch.cells.cell import run_cell
    from hangtime.batch.cells.work import Done
    from hangtime.solver.data.faults import NoSolution
    from hangtime.solver.data.status import Status

    def log(line: str) -> None:
        with (folder / WORK_LOG).open("a") as file:
            file.write(f"{line}\n")

    def work(_settings: Any, plan: Any, _fits: Any, outbox: Any, _stages: Any) -> Done:
        begun = lines(folder, "begin")
        log(f"begin {plan.cell} {os.getpid()}")
        text = Path(plan.clip).read_text()
        if text == "dies" or (text == "dies once" and plan.cell not in begun):
            os._exit(9)
        if text == "crash":
            raise ZeroDivisionError("by a fault of ours")
        if text == "temporary":
            log(f"temporary {tempfile.mkdtemp(prefix='blender_')}")
        if text == "fault":
            raise NoSolution(Status.STALLED)
        if text.startswith("sleep"):
            time.sleep(float(text.split()[1]))
        outbox.write_text("answer.txt", f"{text}\n" * 1000)
        log(f"end {plan.cell}")
        worse = float(text == "worse")
        return Done(("Solved.",), {"answer_m": 1.0, "certificate_worse_than_recorded": worse})

    return lambda cell: run_cell(folder, cell, work=work)


if __name__ == "__main__":
    runpy.run_path(str(ROOT / "solver" / "worker" / "program.py"))["load_package"](ROOT)
    if len(sys.argv) > 1:
        from hangtime.batch.records.locks import batch_lock

        with batch_lock(Path(sys.argv[1])):
            run(Path(sys.argv[1]), int(sys.argv[2]))
    else:
        from hangtime.batch.running.worker import main

        print("Blender 4.5.0 (hash of its build)", flush=True)  # as Blender greets
        main(_solver)
