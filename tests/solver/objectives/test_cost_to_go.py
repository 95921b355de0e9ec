"""The cost-to-go at a motion's ends is the least cost of coming back to the target beyond them."""

import numpy as np
import pytest
from hangtime.solver.numerics.splines import SplineBasis, gauss_instants
from hangtime.solver.objectives.cost_to_go import CostToGo
from hangtime.solver.objectives.motion_metric import motion_target
from hangtime.solver.objectives.tracking_cost import marker_points
from hangtime.solver.transcription.motion import Motion
from hangtime.tests.helpers.toy_problems import places, random_state, standing

TIME = 0.05  # s
DURATION = 0.3  # s, of the toy motion


def least_cost(error: float, velocity: float) -> float:
    """Half the least ∫ e² + τ⁴ e''² dt over a long time, of an error that begins so."""
    breaks = np.linspace(0.0, 20.0 * TIME, 400)
    basis = SplineBasis(breaks, np.zeros(len(breaks), dtype=bool))
    times, weights, _ = gauss_instants(breaks, 4)
    rows = [basis.matrix(times), TIME**2 * basis.matrix(times, 2)]
    cost = sum(row.T @ (weights[:, None] * row) for row in rows)
    start = np.linalg.solve([basis.matrix(breaks[:1], k)[0, :2] for k in (0, 1)], [error, velocity])
    rest = -np.linalg.solve(cost[2:, 2:], cost[2:, :2] @ start)
    e = np.concatenate([start, rest])
    return 0.5 * float(e @ cost @ e)


def cost_of(shift: float, drift: float, weights: tuple[float, float] = (1.0, 1.0)) -> float:
    """Of a motion that is off by shift (m) + drift (m/s) t from its target."""
    x, t = random_state(3), standing()
    target = motion_target(Motion(t, x, places())).ends
    to_go = CostToGo(t, target, marker_points(t.character), TIME, weights)
    assert to_go.value(x) == pytest.approx(0.0, abs=1e-20)
    moved = x.copy()
    knots = t.basis.knots
    greville = (knots[1:-3] + knots[2:-2] + knots[3:-1]) / 3.0
    moved[:, 0] += shift + drift * greville
    return to_go.value(moved)


@pytest.mark.parametrize(("shift", "drift"), [(0.1, 0.0), (0.0, 1.0), (0.1, 0.7), (0.1, -0.7)])
def test_it_is_the_least_cost_of_coming_back(shift: float, drift: float) -> None:
    """At the end as time goes on, at the start as it runs back."""
    last = least_cost(shift + drift * DURATION, drift)
    assert cost_of(shift, drift) == pytest.approx(least_cost(shift, -drift) + last, rel=1e-3)


@pytest.mark.parametrize("weights", [(3.0, 0.0), (0.0, 2.0)])
def test_each_end_has_its_weight(weights: tuple[float, float]) -> None:
    before, after = least_cost(0.1, -0.7), least_cost(0.1 + 0.7 * DURATION, 0.7)
    expected = weights[0] * before + weights[1] * after
    assert cost_of(0.1, 0.7, weights) == pytest.approx(expected, rel=1e-3)
