"""What a pair's source is asked for, what comes back, and the processes that do it.

A process of its own fits one source and adapts it to all of its targets: memory and any crash are
each one's own, and the fit is made once.
"""

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from ...solver.arrays import FloatArray
from ..processes import dump, run_module, undump
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
    said = run_module("devtools.pairs.solve", [str(given), str(found)])
    if said is None:
        solved = undump(found)
        assert isinstance(solved, SolvedSource)
        print(f"{task.source.name}: {len(solved.adapted)} adaptations", flush=True)
        return solved
    print(f"{task.source.name}: {said}", flush=True)
    return SolvedSource(said, {})
