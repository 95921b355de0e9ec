"""Scaling (thesis 4.1) on its pendulum: 70 kg, 1.70 m, with a torque at the pivot.

Finds the physically valid swing nearest to a given one: spline coefficients of the angle and of
the torque are unknown, the equation of motion holds at Gauss points. The optimiser is sequential
quadratic programming with a Hessian built from gradients (BFGS), as in 2004, and does not scale by
itself. With the mass density times 0.001, or with forces in body weights, the torques come out
scaled by as much and the swing is the same, after far fewer iterations.

    python devtools/package.py benchmarks.pendulum
"""

from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np

from ..solver.arrays import FloatArray
from ..solver.data.constants import STANDARD_GRAVITY
from ..solver.numerics.splines import SplineBasis, gauss_instants

MASS = 70.0  # kg
LENGTH = 1.70  # m, of a uniform rod
DURATION = 1.5  # s
SPANS = 12
GAUSS = 2
TOLERANCE = 1e-8
MOST_ITERATIONS = 2000
SCALES = {  # of the mass density
    "unscaled": 1.0,
    "mass density x 0.001": 0.001,
    "body weights": 1.0 / (MASS * STANDARD_GRAVITY),
}


@dataclass(frozen=True)
class Swing:
    """A solved swing: angle (T,) rad and torque (T,) N·m at `times` (T,) s, and what it took."""

    times: FloatArray
    angle: FloatArray
    torque: FloatArray
    iterations: int
    solved: bool


def wanted(times: FloatArray) -> FloatArray:
    """(T,) rad: a swing that gravity alone does not allow."""
    return np.asarray(0.8 * np.cos(2.0 * np.pi * times / DURATION) + 0.3 * times)


def basis() -> SplineBasis:
    """The splines of angle and torque."""
    return SplineBasis(np.linspace(0.0, DURATION, SPANS + 1), np.zeros(SPANS + 1, dtype=bool))


def solve(scale: float) -> Swing:
    """The valid swing nearest to the wanted one, from zero, with the mass times `scale`."""
    times, weights, _ = gauss_instants(basis().breaks, GAUSS)
    count = basis().n_coefficients
    x = ca.SX.sym("x", 2 * count)
    value, bend = ca.DM(basis().matrix(times)), ca.DM(basis().matrix(times, 2))
    angle, acceleration = value @ x[:count], bend @ x[:count]
    error = unbalanced(angle, acceleration, value @ x[count:], scale)
    distance = ca.dot(ca.DM(weights), (angle - ca.DM(wanted(times))) ** 2)
    solver = ca.nlpsol("swing", "sqpmethod", {"x": x, "f": distance, "g": error}, _options())
    unknowns = np.asarray(solver(x0=0.0, lbg=0.0, ubg=0.0)["x"]).ravel()
    dense = np.linspace(0.0, DURATION, 201)
    values = basis().matrix(dense)
    stats = solver.stats()
    return Swing(
        times=dense,
        angle=values @ unknowns[:count],
        torque=values @ unknowns[count:] / scale,
        iterations=int(stats["iter_count"]),
        solved=bool(stats["success"]),
    )


def unbalanced(angle: ca.SX, acceleration: ca.SX, torque: ca.SX, scale: float) -> ca.SX:
    """What the rod's equation of motion about its pivot leaves over."""
    mass = scale * MASS
    inertia, weight = mass * LENGTH**2 / 3.0, 0.5 * mass * STANDARD_GRAVITY * LENGTH
    return inertia * acceleration + weight * ca.sin(angle) - torque


def _options() -> dict[str, Any]:
    quiet = {"print_time": False, "print_header": False, "print_status": False}
    inner = {"print_iter": False, "print_header": False, "print_info": False}
    return {
        **quiet,
        "print_iteration": False,
        "hessian_approximation": "limited-memory",
        "lbfgs_memory": 200,
        "max_iter": MOST_ITERATIONS,
        "tol_pr": TOLERANCE,
        "tol_du": TOLERANCE,
        "qpsol": "qrqp",
        "qpsol_options": {**inner, "error_on_fail": False},
    }


def main(argv: list[str]) -> int:
    """Prints the iterations of each, and how far the swings are apart."""
    del argv
    swings = {name: solve(scale) for name, scale in SCALES.items()}
    plain = swings["unscaled"]
    for name, swing in swings.items():
        apart = np.abs(swing.angle - plain.angle).max()
        print(f"{name:22s}{swing.iterations:5d} iterations, {apart:.0e} rad from the unscaled")
    return 0 if all(swing.solved for swing in swings.values()) else 1
