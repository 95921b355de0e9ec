"""What a pair's source is asked for, what comes back, and the processes that do it.

A process of its own fits one source and adapts it to all of its targets: memory and any crash are
each one's own, and the fit is made once.
"""

import os
import pickle
import subprocess
import sys
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...solver.arrays import FloatArray
from ...solver.one_thread import ONE_THREAD
from ..environment.virtual_environment import ROOT
from .clips import Jump
from .jump_measures import JumpMeasures
from .phased_jump import PhasedJump


@dataclass(frozen=True)
class SourceTask:
    """A source, and by target how far its landing must move, (3,) m, world."""

    source: Jump
    offsets: dict[str, FloatArray]
    solutions: tuple[str, ...]


@dataclass(frozen=True)
class SolvedJump:
    """A fit or an adaptation. status: of the solve, in a word; seconds: that it took."""

    solved: bool
    status: str
    seconds: float
    phases: PhasedJump
    measures: JumpMeasures


@dataclass(frozen=True)
class SolvedSource:
    """A source's fit, and its adaptations by (target, solution); a string tells a failure."""

    fit: SolvedJump | str
    adapted: dict[tuple[str, str], SolvedJump | str]


def solve_all(tasks: Sequence[SourceTask], folder: Path, jobs: int) -> list[SolvedSource]:
    """Solves the tasks in processes, `jobs` at a time."""
    with ThreadPoolExecutor(jobs) as pool:
        return list(pool.map(lambda task: _solve(task, folder), tasks))


def _solve(task: SourceTask, folder: Path) -> SolvedSource:
    given, found = (folder / f"{task.source.name}.{kind}.pickle" for kind in ("given", "found"))
    dump(task, given)
    launcher = str(ROOT / "devtools" / "package.py")
    command = [sys.executable, launcher, "devtools.pairs.solve", str(given), str(found)]
    done = subprocess.run(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
        env=os.environ | ONE_THREAD,
    )
    if done.returncode == 0:
        solved = undump(found)
        assert isinstance(solved, SolvedSource)
        print(f"{task.source.name}: {len(solved.adapted)} adaptations", flush=True)
        return solved
    lines = done.stdout.strip().splitlines() or [f"ended with code {done.returncode}"]
    print(f"{task.source.name}: {lines[-1]}", flush=True)
    return SolvedSource(lines[-1], {})


def dump(content: object, path: Path) -> None:
    """A scratch file for the next process."""
    path.write_bytes(pickle.dumps(content))


def undump(path: Path) -> Any:
    """Reads what `dump` wrote; only ever of our own making."""
    return pickle.loads(path.read_bytes())
