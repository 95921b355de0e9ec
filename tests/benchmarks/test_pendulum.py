"""Scaling (thesis 4.1): fewer iterations, the same swing."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hangtime.benchmarks.pendulum import LENGTH, MASS, SCALES, Swing, main, solve, wanted
from hangtime.solver.body.dynamics import MomentFunction
from hangtime.solver.data.constants import STANDARD_GRAVITY
from hangtime.tests.helpers.toy_problems import figure


@cache
def swings() -> dict[str, Swing]:
    return {name: solve(scale) for name, scale in SCALES.items()}


@pytest.mark.parametrize("name", [name for name in SCALES if name != "unscaled"])
def test_scaling_needs_far_fewer_iterations_for_the_same_swing(name: str) -> None:
    plain, scaled = swings()["unscaled"], swings()[name]
    assert plain.solved
    assert scaled.solved
    assert 2 * scaled.iterations < plain.iterations
    assert scaled.angle == pytest.approx(plain.angle, abs=1e-6)
    assert scaled.torque == pytest.approx(plain.torque, abs=1e-3)


def test_the_swing_obeys_the_pendulum_and_stays_near_what_was_wanted() -> None:
    swing = swings()["body weights"]
    step = swing.times[1]
    bend = np.gradient(np.gradient(swing.angle, step), step)
    inertia, weight = MASS * LENGTH**2 / 3.0, 0.5 * MASS * STANDARD_GRAVITY * LENGTH
    left = inertia * bend + weight * np.sin(swing.angle) - swing.torque
    assert np.sqrt((left[5:-5] ** 2).mean()) < 0.02 * np.abs(swing.torque).max()
    assert np.abs(swing.angle - wanted(swing.times)).max() < 0.1


def test_the_comparison_can_be_run(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == 0
    assert capsys.readouterr().out.count("iterations") == len(SCALES)


def test_the_solver_s_own_equations_are_in_body_weights() -> None:
    """So a figure of any density has the same equations."""
    light = replace(
        figure(),
        bodies=tuple(
            replace(b, mass=0.001 * b.mass, inertia=0.001 * b.inertia) for b in figure().bodies
        ),
    )
    state = np.random.default_rng(0).normal(size=(3, 4, figure().n_angles))
    heavy = MomentFunction(figure()).value(*state)
    assert MomentFunction(light).value(*state) == pytest.approx(heavy, rel=1e-9)
