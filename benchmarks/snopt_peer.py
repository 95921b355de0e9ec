"""Drake with SNOPT, the thesis's solver, on the very problem that an adaptation solves.

The same unknowns, rows, sparse Jacobian and start; every row keeps to its bounds within our
tolerance. Rows that are linear are declared so; the others come as one Python function of values
and derivatives whose sparsity is declared; the objective is Drake's own quadratic cost. SNOPT sees
first derivatives alone, as ever, and builds its Hessian from them.

SNOPT looks at its clock between major iterations only, and its first quadratic program alone may
take minutes. So it runs in a process of its own that is ended when its time is up; it is then
judged where it last asked for the rows. The process is begun afresh: one that is forked would wait
for ever for the parent's threads, which a fork leaves behind.
"""

from __future__ import annotations

import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from pydrake.autodiffutils import ExtractValue, InitializeAutoDiff
from pydrake.solvers import MathematicalProgram, SnoptSolver, SolverOptions

from ..devtools.peers.task import Equations, PeerResult, Task, judged, metric_matrix
from ..devtools.processes import LAUNCHER, dump, undump
from ..solver.arrays import BoolArray, FloatArray
from ..solver.data.row_kinds import RowKind
from .watched_process import Limits, run

LINEAR = (RowKind.BALANCE, RowKind.PUSH)
SET_UP = 120.0  # s, at most, from the process's start to SNOPT's
GRACE = 1.0  # s, for the process to hand over its answer
TIME_IS_UP = "ended when its time was up"


def solve(task: Task, limit_s: float) -> PeerResult:
    """Solves a task by SNOPT; the limit is for its iterations, without the set-up.

    Raises RuntimeError with what the process said last, if it failed.
    """
    started = time.perf_counter()
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        board = _Board.made(folder, task.start[task.transcription.active])
        dump(task, folder / "task")
        command = [sys.executable, str(LAUNCHER), "benchmarks.snopt_peer", scratch, str(limit_s)]
        limits = Limits(SET_UP, limit_s + GRACE)
        run(command, folder / "said", limits, lambda: board.begun > 0.0)
        ended = time.perf_counter()
        ready = board.begun or ended
        last = task.unpack(np.array(board.x))
        status, asked = board.status or TIME_IS_UP, int(board.times[1])
    return judged(task, last, ended - ready, ready - started, asked, status)


@dataclass(frozen=True)
class _Board:
    """What the process tells meanwhile, in files that both map into memory.

    x: (n,) the unknowns it last asked the rows for. times: (2,) when SNOPT began (s, by the
    machine's clock, which both read alike), and how often it asked.
    """

    folder: Path
    x: FloatArray
    times: FloatArray

    @staticmethod
    def made(folder: Path, start: FloatArray) -> _Board:
        """A new one, nothing told."""
        np.save(folder / "x.npy", start)
        np.save(folder / "times.npy", np.zeros(2))
        return _Board.of(folder)

    @staticmethod
    def of(folder: Path) -> _Board:
        """The one in a folder."""
        return _Board(
            folder, *(np.load(folder / name, mmap_mode="r+") for name in ("x.npy", "times.npy"))
        )

    @property
    def begun(self) -> float:
        """When SNOPT began, s; 0 before."""
        return float(self.times[0])

    @property
    def status(self) -> str:
        """How SNOPT ended; empty before."""
        path = self.folder / "status"
        return path.read_text(encoding="utf-8") if path.exists() else ""


def main(argv: list[str]) -> int:
    """In the process: argv are the folder and the limit, s."""
    folder, limit_s = Path(argv[0]), float(argv[1])
    task: Task = undump(folder / "task")
    _work(task, limit_s, _Board.of(folder))
    return 0


def _work(task: Task, limit_s: float, board: _Board) -> None:
    equations = Equations(task)
    start = task.start[task.transcription.active]
    program = MathematicalProgram()
    x = program.NewContinuousVariables(equations.size)
    metric = metric_matrix(task).toarray()
    slope = metric @ start
    program.AddQuadraticCost(metric, -slope, 0.5 * start @ slope, x, True)
    _constrain(program, x, equations, start, board)
    options = SolverOptions()
    for name, value in {
        "Time limit": limit_s,
        "Superbasics limit": equations.size,
        "Major iterations limit": 10**6,
        "Iterations limit": 10**9,
    }.items():
        options.SetOption(SnoptSolver.id(), name, value)
    board.times[0] = time.perf_counter()
    result = SnoptSolver().Solve(program, start, options)
    board.x[:] = result.GetSolution(x)
    info = result.get_solver_details().info
    words = f"SNOPT {info}, {result.get_solution_result().name}"
    (board.folder / "status").write_text(words, encoding="utf-8")


def _constrain(
    program: Any, x: Any, equations: Equations, start: FloatArray, board: _Board
) -> None:
    """Linear rows as linear constraints, the others as a function."""
    value, jacobian = equations.jacobian(start)
    linear = np.array([kind in LINEAR for kind in equations.kind])
    constant = (value - jacobian @ start)[linear]
    lower, upper = equations.lower, equations.upper
    program.AddLinearConstraint(
        jacobian[linear], lower[linear] - constant, upper[linear] - constant, x
    )
    curved = Curved(equations, ~linear, board)
    binding = program.AddConstraint(curved, lower[~linear], upper[~linear], x)
    pattern = equations.pattern[~linear].tocoo()
    pairs = zip(pattern.row.tolist(), pattern.col.tolist(), strict=True)
    binding.evaluator().SetGradientSparsityPattern(list(pairs))


class Curved:
    """Some of the rows for Drake: values of numbers, derivatives of AutoDiff numbers."""

    def __init__(self, equations: Equations, which: BoolArray, board: _Board) -> None:
        self.equations, self.which, self.board = equations, which, board

    def __call__(self, x: Any) -> Any:
        if x.dtype != object:
            return self.equations.values(x)[self.which]
        packed = np.asarray(ExtractValue(x)).ravel()
        self.board.x[:] = packed
        self.board.times[1] += 1
        values, jacobian = self.equations.jacobian(packed)
        # Drake's SNOPT asks with the identity as derivative, so the chain rule is done already.
        return InitializeAutoDiff(values[self.which], jacobian[self.which].toarray())
