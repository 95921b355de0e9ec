"""Batches of hops by the wheel's own program, in processes of their own."""

from __future__ import annotations

import os
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path
from random import Random

from ...batch.records.manifest import Manifest
from ...batch.records.result import CELLS, RESULT
from ...solver.one_thread import ONE_THREAD
from .installed import program_in
from .plans import CLIP, contents, differing, half_written, plan_hops, recipe_of

SOON, LATE = 0.3, 7.0  # s after its start, between which a batch is killed
LOOK = 0.02  # s between looks at a run, of whose cells each takes much longer
PATIENCE = 60.0  # s, in which a worker ends whose batch was killed, however busy the machine is


@dataclass(frozen=True)
class LocalRunTime:
    """A run on this machine. seconds: from the command to its end, on the wall's clock."""

    manifest: Manifest
    seconds: float


def run_local(folder: Path, package: Path, cells: int, jobs: int) -> LocalRunTime:
    """Plan and solve so many hops. Raises CalledProcessError."""
    manifest = plan_hops(folder, cells)
    began = time.perf_counter()
    end_at(folder, package, None, jobs)
    return LocalRunTime(manifest, time.perf_counter() - began)


def command(folder: Path, package: Path, jobs: int) -> list[str]:
    """What a user would type, for a batch that `plan_hops` planned."""
    words = [str(program_in(package)), "run", str(CLIP), "--recipes", str(recipe_of(folder))]
    return [*words, "--out", str(folder), "--jobs", str(jobs)]


def killed_and_resumed(
    folder: Path, package: Path, expected: dict[str, str], chance: Random, kills: int
) -> int:
    """Kill batches at random moments, each resumed by the same command until it ends; how many
    cells were lost, half-written, different or solved again: begun, though a run before had ended
    them. expected: contents of such a batch."""
    bad, killed, batches = 0, 0, 0
    while killed < kills:
        batch = folder / f"killed {batches}"
        batches += 1
        manifest = plan_hops(batch, len(expected))
        ended: dict[Path, int] = {}
        while True:
            moment = chance.uniform(SOON, LATE) if killed < kills else None
            begun: set[Path] = set()
            left = at_work(batch)  # by workers of the run before, which may only just have died
            whole = end_at(batch, package, moment, begun=begun)
            killed += not whole
            now = results(batch)
            again = {path for path, written in ended.items() if now.get(path) != written}
            cells = {cell_of(aside) for aside in begun - left}
            bad += len(again | {path for path in ended if path.parent.name in cells})
            ended = now
            if whole:
                break
        half = left_half_written(batch, package)
        bad += len({*differing(contents(batch, manifest), expected), *half})
    return bad


def left_half_written(batch: Path, package: Path) -> list[str]:
    """What is half-written though the same command was given again: it sweeps up what a worker of a
    killed batch was at, once that has ended."""
    until = time.monotonic() + PATIENCE
    while (left := half_written(batch)) and time.monotonic() < until:
        end_at(batch, package, None)
    return left


def end_at(
    batch: Path,
    package: Path,
    moment: float | None,
    jobs: int = 2,
    begun: set[Path] | None = None,
) -> bool:
    """Run a batch for so many seconds, or until it ends; whether it ended by itself.

    begun: takes the folders aside of cells that are seen to be at work. Raises CalledProcessError
    where it ended badly.
    """
    words = command(batch, package, jobs)
    variables = {**os.environ, **ONE_THREAD}
    until = float("inf") if moment is None else time.monotonic() + moment
    with subprocess.Popen(words, stdout=subprocess.DEVNULL, env=variables) as process:
        while (code := process.poll()) is None:
            if time.monotonic() > until:
                process.kill()
                return False
            if begun is not None:
                begun |= at_work(batch)
            time.sleep(LOOK)
    if code:
        raise subprocess.CalledProcessError(code, words)
    return True


def at_work(batch: Path) -> set[Path]:
    """Folders of cells that are still aside: some worker is, or was when it was killed, at them."""
    return set(batch.glob(f"{CELLS}/.*"))


def cell_of(aside: Path) -> str:
    """The cell that a folder aside is of."""
    return aside.name.split(".")[1]


def results(batch: Path) -> dict[Path, int]:
    """When each result was written, ns; of cells in their place, not of those that a worker of a
    killed batch had still aside."""
    return {path: path.stat().st_mtime_ns for path in batch.glob(f"{CELLS}/[!.]*/{RESULT}")}
