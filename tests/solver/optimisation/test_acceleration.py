"""Acceleration of fixed-point iterations."""

import numpy as np
from hangtime.solver.optimisation.acceleration import Anderson


def test_a_linear_iteration_ends_after_as_many_steps_as_it_has_rates() -> None:
    """Plain, the slowest part would lose two hundredths a step."""
    random = np.random.default_rng(0)
    turn = np.linalg.qr(random.normal(size=(6, 6)))[0]
    rates = np.array([0.98, 0.98, 0.9, 0.9, 0.3, 0.3])
    pull = turn @ np.diag(1.0 - rates) @ turn.T
    goal, y, accelerated = random.normal(size=(2, 3)), np.zeros((2, 3)), Anderson()
    for _ in range(4):
        y = accelerated.next(y, (pull @ (goal - y).ravel()).reshape(2, 3))
    assert np.abs(y - goal).max() < 1e-9
