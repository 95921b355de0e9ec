"""The fair peer: IPOPT on the very problem that an adaptation solves.

The same unknowns, rows, hand-assembled sparse Jacobian, start and metric as `solver.adapt`; every
row keeps to its bounds within the tolerance that our own solver stops at; the objective is the
squared distance to the start in the adaptation's metric, so its Hessian is constant.
"""

import time
from typing import Any

import casadi as ca
import numpy as np
from scipy.sparse import csc_matrix

from ...solver.arrays import FloatArray
from .task import Equations, PeerResult, Task, judged, metric_matrix

Buffers = tuple[memoryview, ...]
# The best of about thirty settings tried on this problem: with a fixed plan for mu instead, or
# without second-order corrections, the friction cones keep it from an end; the rows are in body
# weights and metres already.
OPTIONS: dict[str, str | int | float] = {
    "print_level": 0,
    "sb": "yes",
    "hessian_constant": "yes",
    "nlp_scaling_method": "none",
    "mu_strategy": "adaptive",
    "mu_init": 1e-5,
    "alpha_for_y": "full",
    "max_soc": 4,
    "tol": 1e-4,
    "constr_viol_tol": 1e-6,  # a tenth of the narrowest bounds
}


def solve(task: Task, limit_s: float) -> PeerResult:
    """Solves a task by IPOPT; its `seconds` leave out the set-up, which ours has in the fit."""
    begun = time.perf_counter()
    equations = Equations(task)
    x = ca.MX.sym("x", equations.size)
    metric = sparse(metric_matrix(task))
    away = x - task.start[task.transcription.active]
    objective = 0.5 * ca.dot(away, ca.mtimes(metric, away))
    values, jacobian = _Values(equations), _Jacobian(equations)
    options = {
        "jac_g": jacobian,
        "hess_lag": _hessian(metric, equations.size, equations.count),
        "no_nlp_grad": True,
        "ipopt": {**OPTIONS, "max_wall_time": limit_s},
    }
    bounds = equations.lower, equations.upper
    return run(task, {"x": x, "f": objective, "g": values(x)}, options, bounds, begun)


def run(
    task: Task,
    problem: dict[str, ca.MX],
    options: dict[str, Any],
    bounds: tuple[FloatArray, FloatArray],
    begun: float,
) -> PeerResult:
    """Runs IPOPT from the task's start. bounds: (R,) each, of the problem's rows; begun: when the
    set-up began, by the performance counter."""
    quiet = {"print_time": False, "error_on_fail": False}
    solver = ca.nlpsol("peer", "ipopt", problem, {**quiet, **options})
    ready = time.perf_counter()
    start = task.start[task.transcription.active]
    found = solver(x0=start, lbg=bounds[0], ubg=bounds[1])
    seconds = time.perf_counter() - ready
    stats = solver.stats()
    last = task.unpack(np.asarray(found["x"]).ravel())
    iterations, status = int(stats["iter_count"]), str(stats["return_status"])
    return judged(task, last, seconds, ready - begun, iterations, status)


def sparse(matrix: csc_matrix) -> ca.DM:
    """The matrix as CasADi's."""
    return ca.DM(_sparsity(matrix), matrix.data)


def _sparsity(matrix: csc_matrix) -> ca.Sparsity:
    rows, columns = matrix.shape
    return ca.Sparsity(rows, columns, matrix.indptr.tolist(), matrix.indices.tolist())


class _Values(ca.Callback):
    """x -> the rows."""

    def __init__(self, equations: Equations) -> None:
        super().__init__()
        self.equations = equations
        self.construct("rows", {})

    def get_sparsity_in(self, _: int) -> ca.Sparsity:
        return ca.Sparsity.dense(self.equations.size)

    def get_sparsity_out(self, _: int) -> ca.Sparsity:
        return ca.Sparsity.dense(self.equations.count)

    def has_eval_buffer(self) -> bool:
        return True

    def eval_buffer(self, arg: Buffers, res: Buffers) -> int:
        _put(res[0], self.equations.values(_array(arg[0])))
        return 0


class _Jacobian(ca.Callback):
    """(x, p) -> the rows and their Jacobian."""

    def __init__(self, equations: Equations) -> None:
        super().__init__()
        self.equations = equations
        self.sparsity = _sparsity(equations.pattern)
        self.construct("jac_g", {})

    def get_n_in(self) -> int:
        return 2

    def get_n_out(self) -> int:
        return 2

    def get_sparsity_in(self, i: int) -> ca.Sparsity:
        return ca.Sparsity.dense(self.equations.size if i == 0 else 0)

    def get_sparsity_out(self, i: int) -> ca.Sparsity:
        return ca.Sparsity.dense(self.equations.count) if i == 0 else self.sparsity

    def has_eval_buffer(self) -> bool:
        return True

    def eval_buffer(self, arg: Buffers, res: Buffers) -> int:
        values, jacobian = self.equations.jacobian(_array(arg[0]))
        _put(res[0], values)
        _put(res[1], jacobian.data)
        return 0


def _array(buffer: memoryview) -> FloatArray:
    return np.frombuffer(buffer, dtype=np.float64)


def _put(buffer: memoryview | None, values: FloatArray) -> None:
    """Outputs that nobody asked for come as nothing."""
    if buffer is not None and len(buffer):
        np.frombuffer(buffer, dtype=np.float64)[:] = values


def _hessian(metric: ca.DM, n: int, rows: int) -> ca.Function:
    """The constant Hessian as the Lagrangian's: that of the rows is left out (Gauss-Newton)."""
    sizes = (n, 0, 1, rows)
    names = ("x", "p", "lam_f", "lam_g")
    inputs = [ca.MX.sym(name, size) for name, size in zip(names, sizes, strict=True)]
    return ca.Function("hess_lag", inputs, [inputs[2] * ca.triu(metric)])
