"""Drake with SNOPT, the thesis's solver, on the very problem that an adaptation solves.

The same unknowns, rows, sparse Jacobian and start; every row keeps to its bounds within our
tolerance. Rows that are linear are declared so; the others come as one Python function of values
and derivatives whose sparsity is declared; the objective is Drake's own quadratic cost. SNOPT sees
first derivatives alone, as ever, and builds its Hessian from them.

SNOPT looks at its clock between major iterations only, and its first quadratic program alone may
take minutes. So it runs in a process of its own that is ended when its time is up; it is then
judged where it last asked for the rows.
"""

import multiprocessing
import time
from dataclasses import dataclass
from multiprocessing.sharedctypes import SynchronizedArray
from typing import Any

import numpy as np
from pydrake.autodiffutils import ExtractValue, InitializeAutoDiff
from pydrake.solvers import MathematicalProgram, SnoptSolver, SolverOptions

from ..devtools.peers.task import Equations, PeerResult, Task, judged, metric_matrix
from ..solver.arrays import BoolArray, FloatArray
from ..solver.data.row_kinds import RowKind

LINEAR = (RowKind.BALANCE, RowKind.PUSH)
GRACE = 1.0  # s, for the process to hand over its answer
TIME_IS_UP = "ended when its time was up"


def solve(task: Task, limit_s: float) -> PeerResult:
    """Solves a task by SNOPT; the limit is for its iterations, without the set-up."""
    begun = time.perf_counter()
    equations = Equations(task)
    start = task.start[task.transcription.active]
    apart = multiprocessing.get_context("fork")  # the problem is inherited, not sent
    board = _Board(apart.Array("d", start.tolist()), apart.Array("d", 2), apart.Array("c", 200))
    process = apart.Process(target=_work, args=(task, equations, start, limit_s, board))
    process.start()
    while process.is_alive() and not board.begun:
        process.join(0.05)
    ready = board.begun or time.perf_counter()
    process.join(limit_s + GRACE)
    ended = time.perf_counter()
    if process.is_alive():
        process.kill()
        process.join()
    last = task.unpack(np.array(board.x[:]))
    status = board.status.value.decode() or TIME_IS_UP
    return judged(task, last, ended - ready, ready - begun, int(board.times[1]), status)


@dataclass
class _Board:
    """What the process tells meanwhile: x, the unknowns it last asked the rows for; times, when
    SNOPT began (s) and how often it asked; status, how it ended."""

    x: "SynchronizedArray[float]"
    times: "SynchronizedArray[float]"
    status: Any

    @property
    def begun(self) -> float:
        return self.times[0]


def _work(
    task: Task, equations: Equations, start: FloatArray, limit_s: float, board: _Board
) -> None:
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
    board.times[0] = time.perf_counter()  # of the whole machine, so the parent may compare
    result = SnoptSolver().Solve(program, start, options)
    board.x[:] = result.GetSolution(x).tolist()
    info = result.get_solver_details().info
    board.status.value = f"SNOPT {info}, {result.get_solution_result().name}".encode()


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
        self.board.x[:] = packed.tolist()
        self.board.times[1] += 1
        values, jacobian = self.equations.jacobian(packed)
        # Drake's SNOPT asks with the identity as derivative, so the chain rule is done already.
        return InitializeAutoDiff(values[self.which], jacobian[self.which].toarray())
