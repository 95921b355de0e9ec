"""The fair peer: IPOPT on the very problem that an adaptation solves.

The same unknowns, rows, hand-assembled sparse Jacobian, start and metric as `solver.adapt`; every
row is a pair of bounds of the tolerance that our own solver stops at; the objective is the squared
distance to the start in the adaptation's metric, so its Hessian is constant.
"""

import time
from dataclasses import dataclass

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ..solver.adapt import carry, stance_moves
from ..solver.fit import Fit
from ..solver.linear import BAND, BlockBanded
from ..solver.problem import MotionProblem, pinned_places
from ..solver.projection import PULL_TOLERANCE, TOLERANCE, worst_violation
from ..solver.splines import ORDER
from ..solver.transcription import Transcription

FloatArray = NDArray[np.float64]
Buffers = tuple[memoryview, ...]
# The fastest of about twenty settings tried on this problem: a start near the bounds, full steps of
# the multipliers, no second-order corrections; the rows are in body weights and metres already.
OPTIONS: dict[str, str | int | float] = {
    "print_level": 0,
    "sb": "yes",
    "hessian_constant": "yes",
    "nlp_scaling_method": "none",
    "mu_init": 1e-5,
    "alpha_for_y": "full",
    "max_soc": 0,
    "tol": 1e-4,
    "constr_viol_tol": 1e-6,  # a tenth of the narrowest bounds
}


@dataclass(frozen=True)
class PeerResult:
    """How IPOPT fared. seconds: of the solve alone; violation: worst over tolerance, at most 1
    when solved; distance: from the start, in the metric; x: (K, n_block) unknowns."""

    seconds: float
    iterations: int
    status: str
    violation: float
    distance: float
    x: FloatArray


def solve_by_ipopt(
    fit: Fit, problem: MotionProblem, *, limit_s: float = 60.0, pushing: bool = False
) -> PeerResult:
    """Adapts a fit by IPOPT in one go. pushing: also bound vertical forces from below."""
    t = fit.motion.transcription
    goal = pinned_places(problem, fit.performance, fit.schedule)
    start = carried(fit, problem)
    equations = _Equations(t, goal, start)
    n = t.n_unknowns
    x = ca.MX.sym("x", n)
    x0 = start[t.active]
    metric = _sparse(fit.metric, t)
    away = x - x0
    objective = 0.5 * ca.dot(away, ca.mtimes(metric, away))
    violations, jacobian = _Violations(equations), _Jacobian(equations)
    lower = np.full(start.shape, -np.inf)
    if pushing:
        lower[:, t.layout.forces.start + 2 :: 3] = -PULL_TOLERANCE
    solver = ca.nlpsol(
        "peer",
        "ipopt",
        {"x": x, "f": objective, "g": violations(x)},
        {
            "jac_g": jacobian,
            "hess_lag": _hessian(metric, n, equations.count),
            "no_nlp_grad": True,
            "print_time": False,
            "error_on_fail": False,
            "ipopt": {**OPTIONS, "max_wall_time": limit_s},
        },
    )
    bound = equations.tolerance
    begun = time.perf_counter()
    found = solver(x0=x0, lbg=-bound, ubg=bound, lbx=lower[t.active], ubx=np.inf)
    seconds = time.perf_counter() - begun
    stats = solver.stats()
    solved = equations.unpack(np.asarray(found["x"]).ravel())
    return PeerResult(
        seconds,
        int(stats["iter_count"]),
        str(stats["return_status"]),
        worst_violation(t.rows(solved, goal)),
        distance(fit, problem, solved),
        solved,
    )


def carried(fit: Fit, problem: MotionProblem) -> FloatArray:
    """Where both solvers begin: the fit carried along with the pins, (K, n_block)."""
    goal = pinned_places(problem, fit.performance, fit.schedule)
    return carry(fit.motion, stance_moves(fit.schedule, fit.places, goal))


def distance(fit: Fit, problem: MotionProblem, x: FloatArray) -> float:
    """How far unknowns x (K, n_block) are from that start, in the adaptation's metric."""
    step = x - carried(fit, problem)
    return float(np.sqrt((step * fit.metric.times(step)).sum()))


class _Equations:
    """The transcription's rows as a function of the packed unknowns, with a sparse Jacobian."""

    def __init__(self, t: Transcription, places: FloatArray, start: FloatArray) -> None:
        self.t, self.places, self.start = t, places, start
        rows = t.rows(start, places)
        self.count = len(rows.residual)
        self.tolerance = np.array([TOLERANCE[kind] for kind in rows.kind])
        number = np.full(t.active.shape, -1)
        number[t.active] = np.arange(t.n_unknowns)
        columns = number[t.basis.first_coefficient[rows.span][:, None] + np.arange(ORDER)]
        self._used = self._pattern() & (columns >= 0)
        row = np.broadcast_to(np.arange(self.count)[:, None, None], columns.shape)[self._used]
        column = columns[self._used]
        self._order = np.lexsort((row, column))  # CasADi stores columns first
        starts = np.searchsorted(column[self._order], np.arange(t.n_unknowns + 1))
        self.sparsity = ca.Sparsity(
            self.count, t.n_unknowns, starts.tolist(), row[self._order].tolist()
        )

    def _pattern(self) -> NDArray[np.bool_]:
        """Entries that differ from zero at some of a few random places."""
        random = np.random.default_rng(0)
        used = np.zeros(self.t.rows(self.start, self.places).jacobian.shape, dtype=bool)
        for _ in range(3):
            near = self.start + 0.1 * random.normal(size=self.start.shape)
            used |= self.t.rows(near, self.places).jacobian != 0.0
        return used

    def unpack(self, packed: FloatArray) -> FloatArray:
        x = self.start.copy()
        x[self.t.active] = packed
        return x

    def residuals(self, packed: FloatArray) -> FloatArray:
        return self.t.residuals(self.unpack(packed), self.places)

    def jacobian(self, packed: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Residuals and the Jacobian's entries in CasADi's order."""
        rows = self.t.rows(self.unpack(packed), self.places)
        return rows.residual, rows.jacobian[self._used][self._order]


class _Violations(ca.Callback):
    """x -> the rows."""

    def __init__(self, equations: _Equations) -> None:
        super().__init__()
        self.equations = equations
        self.construct("rows", {})

    def get_sparsity_in(self, _: int) -> ca.Sparsity:
        return ca.Sparsity.dense(self.equations.t.n_unknowns)

    def get_sparsity_out(self, _: int) -> ca.Sparsity:
        return ca.Sparsity.dense(self.equations.count)

    def has_eval_buffer(self) -> bool:
        return True

    def eval_buffer(self, arg: Buffers, res: Buffers) -> int:
        _put(res[0], self.equations.residuals(_array(arg[0])))
        return 0


class _Jacobian(ca.Callback):
    """(x, p) -> the rows and their Jacobian."""

    def __init__(self, equations: _Equations) -> None:
        super().__init__()
        self.equations = equations
        self.construct("jac_g", {})

    def get_n_in(self) -> int:
        return 2

    def get_n_out(self) -> int:
        return 2

    def get_sparsity_in(self, i: int) -> ca.Sparsity:
        return ca.Sparsity.dense(self.equations.t.n_unknowns if i == 0 else 0)

    def get_sparsity_out(self, i: int) -> ca.Sparsity:
        return ca.Sparsity.dense(self.equations.count) if i == 0 else self.equations.sparsity

    def has_eval_buffer(self) -> bool:
        return True

    def eval_buffer(self, arg: Buffers, res: Buffers) -> int:
        residuals, entries = self.equations.jacobian(_array(arg[0]))
        _put(res[0], residuals)
        _put(res[1], entries)
        return 0


def _array(buffer: memoryview) -> FloatArray:
    return np.frombuffer(buffer, dtype=np.float64)


def _put(buffer: memoryview | None, values: FloatArray) -> None:
    """Outputs that nobody asked for come as nothing."""
    if buffer is not None and len(buffer):
        np.frombuffer(buffer, dtype=np.float64)[:] = values


def _sparse(metric: BlockBanded, t: Transcription) -> ca.DM:
    """The metric over the unknowns that exist."""
    count, n = t.active.shape
    wide = np.zeros((count, n, ORDER + BAND, n))
    for j in range(BAND + 1):
        blocks = metric.lower[j][: count - j]
        wide[j:, :, BAND - j] = blocks
        wide[: count - j, :, BAND + j] = np.swapaxes(blocks, 1, 2)
    at = np.argwhere(wide != 0.0)
    row = at[:, 0] * n + at[:, 1]
    column = (at[:, 0] + at[:, 2] - BAND) * n + at[:, 3]
    inside = (column >= 0) & (column < count * n)
    inside[inside] &= t.active.ravel()[row[inside]] & t.active.ravel()[column[inside]]
    number = np.cumsum(t.active.ravel()) - 1
    row, column = number[row[inside]], number[column[inside]]
    values = wide[tuple(at[inside].T)]
    order = np.lexsort((row, column))
    starts = np.searchsorted(column[order], np.arange(t.n_unknowns + 1))
    sparsity = ca.Sparsity(t.n_unknowns, t.n_unknowns, starts.tolist(), row[order].tolist())
    return ca.DM(sparsity, values[order])


def _hessian(metric: ca.DM, n: int, rows: int) -> ca.Function:
    """The constant Hessian as the Lagrangian's: that of the rows is left out (Gauss-Newton)."""
    sizes = (n, 0, 1, rows)
    names = ("x", "p", "lam_f", "lam_g")
    inputs = [ca.MX.sym(name, size) for name, size in zip(names, sizes, strict=True)]
    return ca.Function("hess_lag", inputs, [inputs[2] * ca.triu(metric)])
