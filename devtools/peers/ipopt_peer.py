"""The fair peer: IPOPT on the very problem that an adaptation solves.

The same unknowns, rows, hand-assembled sparse Jacobian, start and metric as `solver.adapt`; every
row keeps to its bounds within the tolerance that our own solver stops at; the objective is the
squared distance to the start in the adaptation's metric, so its Hessian is constant.
"""

import time

import casadi as ca
import numpy as np

from ...solver.data.problem import MotionProblem
from ...solver.stages.fit import Fit
from .task import Entries, Equations, FloatArray, PeerResult, Task, judged, metric_entries

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


def solve_by_ipopt(fit: Fit, problem: MotionProblem, *, limit_s: float = 60.0) -> PeerResult:
    """Adapts a fit by IPOPT in one go."""
    return solve(Task.of(fit, problem), limit_s)


def distance(fit: Fit, problem: MotionProblem, x: FloatArray) -> float:
    """How far unknowns x (K, n_block) are from where both begin, in the adaptation's metric."""
    return Task.of(fit, problem).distance(x)


def solve(task: Task, limit_s: float) -> PeerResult:
    """Solves a task by IPOPT; its `seconds` leave out the set-up, which ours has in the fit."""
    begun = time.perf_counter()
    equations = Equations(task)
    n = equations.size
    x = ca.MX.sym("x", n)
    x0 = task.start[task.transcription.active]
    metric = sparse(*metric_entries(task), n, n)
    away = x - x0
    objective = 0.5 * ca.dot(away, ca.mtimes(metric, away))
    values, jacobian = _Values(equations), _Jacobian(equations)
    solver = ca.nlpsol(
        "peer",
        "ipopt",
        {"x": x, "f": objective, "g": values(x)},
        {
            "jac_g": jacobian,
            "hess_lag": _hessian(metric, n, equations.count),
            "no_nlp_grad": True,
            "print_time": False,
            "error_on_fail": False,
            "ipopt": {**OPTIONS, "max_wall_time": limit_s},
        },
    )
    ready = time.perf_counter()
    found = solver(x0=x0, lbg=equations.lower, ubg=equations.upper)
    seconds = time.perf_counter() - ready
    stats = solver.stats()
    last = task.unpack(np.asarray(found["x"]).ravel())
    iterations, status = int(stats["iter_count"]), str(stats["return_status"])
    return judged(task, last, seconds, ready - begun, iterations, status)


def sparse(entries: Entries, values: FloatArray, rows: int, columns: int) -> ca.DM:
    """A sparse matrix of CasADi's."""
    return ca.DM(_sparsity(entries, rows, columns), values)


def _sparsity(entries: Entries, rows: int, columns: int) -> ca.Sparsity:
    return ca.Sparsity(rows, columns, entries.starts(columns), entries.row.tolist())


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
        self.sparsity = _sparsity(equations.entries, equations.count, equations.size)
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
        values, entries = self.equations.jacobian(_array(arg[0]))
        _put(res[0], values)
        _put(res[1], entries)
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
