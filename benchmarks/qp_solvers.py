"""A step's small QP (optimisation/bounds/active_set.py) beside the solvers that CasADi ships.

python devtools/package.py benchmarks.qp_solvers
"""

import time
from collections.abc import Callable, Sequence
from typing import Any

import casadi as ca
import numpy as np

from ..solver.arrays import FloatArray
from ..solver.optimisation.bounds.active_set import multipliers_by_active_set

SIZES = (30, 120, 300)
REPEATS = 5
NEAR = 1e-5  # an answer counts if no row is off by more
SOFT = 1e-7  # as in a step
NEXT = 0.02  # by which the next program's bounds differ; they are 0.1 apart
# osqp and qrqp take 2 to 200 times as long, or do not end.
SOLVERS: dict[str, dict[str, Any]] = {
    "daqp": {},
    "qpoases": {"printLevel": "none", "sparse": False},
    "proxqp": {},
    "piqp": {},
}
Program = tuple[FloatArray, FloatArray, FloatArray]  # stiffness, lower and upper bounds
Solver = Callable[[Program], FloatArray]  # its rows' values


def program(size: int) -> Program:
    """A torque's rows at instants close together: each is much like its neighbours, and all are
    kept between narrow bounds, as of a limp arm."""
    random = np.random.default_rng(size)
    apart = np.subtract.outer(np.arange(size), np.arange(size)) / 6.0
    middle = np.cumsum(random.normal(size=size)) / np.sqrt(size)
    return np.exp(-(apart**2)) + SOFT * np.eye(size), middle - 0.05, middle + 0.05


def by_casadi(name: str, size: int) -> Solver:
    shape = {"h": ca.Sparsity.diag(size), "a": ca.Sparsity.dense(size, size)}
    solver = ca.conic("step", name, shape, {"error_on_fail": False, **SOLVERS[name]})

    def solve(asked: Program) -> FloatArray:
        stiffness, lower, upper = asked
        root = np.linalg.cholesky(stiffness)
        found = solver(h=ca.DM.eye(size), a=root, lba=lower, uba=upper)
        return np.asarray(root @ np.asarray(found["x"]).ravel())

    return solve


def ours(guess: FloatArray) -> Solver:
    def solve(asked: Program) -> FloatArray:
        u = multipliers_by_active_set(*asked, guess)
        return np.full(len(guess), np.nan) if u is None else -asked[0] @ u

    return solve


def solvers(asked: Program) -> dict[str, Solver]:
    """Ours first: from nothing, and from the working set of a program with bounds that are a little
    elsewhere, as the next step's are."""
    size = len(asked[0])
    change = NEXT * np.sin(np.linspace(0.0, 2.0 * np.pi, size))
    last = multipliers_by_active_set(asked[0], asked[1] + change, asked[2] + change, np.zeros(size))
    assert last is not None
    own = {"ours": ours(np.zeros(size)), "from the last": ours(last)}
    return own | {name: by_casadi(name, size) for name in SOLVERS}


def seconds(solver: Solver, asked: Program) -> tuple[float, float]:
    """Fastest of a few solves, and how far a row is off at worst."""
    times, off = [], np.inf
    for _ in range(REPEATS):
        began = time.perf_counter()
        reached = solver(asked)
        times.append(time.perf_counter() - began)
        off = float(max((asked[1] - reached).max(), (reached - asked[2]).max()))
    return min(times), off


def main(_: Sequence[str]) -> int:
    for size in SIZES:
        asked = program(size)
        found = {name: seconds(solver, asked) for name, solver in solvers(asked).items()}
        if size == SIZES[0]:
            print(f"{'rows':>6}" + "".join(f"{name:>15}" for name in found) + "   times ours")
        first = found["ours"][0]
        cells = [
            f"{taken / first:>15.2f}" if off < NEAR else f"{'not solved':>15}"
            for taken, off in found.values()
        ]
        print(f"{size:>6}" + "".join(cells) + f"   ({1000 * first:.1f} ms)")
    return 0
