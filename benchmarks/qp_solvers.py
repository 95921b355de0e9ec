"""Which solver that CasADi ships is fastest on a step's small QP (optimisation/bounded_qp.py).

python devtools/package.py benchmarks.qp_solvers
"""

import time
from collections.abc import Sequence
from typing import Any

import casadi as ca
import numpy as np

from ..solver.arrays import FloatArray

SIZES = (30, 120, 300)
REPEATS = 5
NEAR = 1e-5  # a solver's answer counts if no row is off by more
SOLVERS: dict[str, dict[str, Any]] = {
    "daqp": {},
    "qpoases": {"printLevel": "none", "sparse": False},
    "osqp": {"osqp": {"verbose": False, "eps_abs": 1e-8, "eps_rel": 1e-8, "max_iter": 20000}},
    "proxqp": {},
    "piqp": {},
    "qrqp": {"print_iter": False, "print_header": False},
}


def program(size: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Root and bounds of a random program with stiffnesses over six orders of magnitude."""
    random = np.random.default_rng(size)
    rows = random.normal(size=(size, 4000)) * np.exp(-6.0 * random.random(size))[:, None]
    stiffness = rows @ rows.T / 4000
    root = np.linalg.cholesky(stiffness + 1e-9 * np.trace(stiffness) / size * np.eye(size))
    width = np.sqrt(np.diagonal(stiffness))
    at = random.normal(size=size) * width
    lower = np.where(np.arange(size) % 3 == 0, -np.inf, -0.5 * width - at)
    return root, lower, 0.5 * width - at


def seconds(name: str, size: int) -> tuple[float, float]:
    """Fastest of a few solves, and how far a row is off at worst."""
    root, lower, upper = program(size)
    shape = {"h": ca.Sparsity.diag(size), "a": ca.Sparsity.dense(size, size)}
    solver = ca.conic("step", name, shape, {"error_on_fail": False, **SOLVERS[name]})
    times, off = [], np.inf
    for _ in range(REPEATS):
        began = time.perf_counter()
        found = solver(h=ca.DM.eye(size), a=root, lba=lower, uba=upper)
        times.append(time.perf_counter() - began)
        reached = root @ np.asarray(found["x"]).ravel()
        off = float(max((lower - reached).max(), (reached - upper).max()))
    return min(times), off


def main(_: Sequence[str]) -> int:
    print(f"{'rows':>6}" + "".join(f"{name:>12}" for name in SOLVERS) + "   times DAQP's")
    for size in SIZES:
        found = {name: seconds(name, size) for name in SOLVERS}
        first = found["daqp"][0]
        cells = [
            f"{taken / first:>12.1f}" if off < NEAR else f"{'not solved':>12}"
            for taken, off in found.values()
        ]
        print(f"{size:>6}" + "".join(cells) + f"   ({1000 * first:.1f} ms)")
    return 0
