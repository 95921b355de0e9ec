"""Tracking cost: its gradient and Hessian against finite differences."""

import numpy as np
import pytest
from hangtime.solver.stages.fit import motion_target
from hangtime.solver.transcription.motion import Motion
from hangtime.solver.transcription.tracking_cost import (
    CostWeights,
    TrackingCost,
    TrackingTarget,
    marker_points,
)
from hangtime.tests.helpers.toy_problems import figure, places, random_state, standing

COST_WEIGHTS = {
    "fit": CostWeights(position=1.0, acceleration_time=0.05, force=1e-4),
    "adaptation": CostWeights(shape=1.0, com=0.02, acceleration_time=0.05, force=3e-3),
    "all": CostWeights(
        position=0.7, shape=0.4, com=0.2, acceleration_time=0.1, force=0.02, force_rate_time=0.1
    ),
}


def at_itself(x: np.ndarray) -> TrackingTarget:
    return motion_target(Motion(standing(), x, places()))


def direction(seed: int) -> np.ndarray:
    t = standing()
    return np.random.default_rng(70 + seed).normal(size=t.active.shape) * t.active


@pytest.mark.parametrize("name", COST_WEIGHTS)
def test_the_gradient_is_the_value_s_slope(name: str) -> None:
    """The acceleration term's own metric is taken as fixed, so that target has no such error."""
    x, target = random_state(0), at_itself(random_state(1))
    t = standing()
    own = at_itself(x)
    target = TrackingTarget(target.markers, target.com, own.accelerations, target.forces)
    tracking_cost = TrackingCost(t, target, COST_WEIGHTS[name])
    gradient, _ = tracking_cost.expand(x)
    for seed in range(3):
        d = direction(seed)
        step = 1e-5
        slope = (tracking_cost.value(x + step * d) - tracking_cost.value(x - step * d)) / (
            2.0 * step
        )
        assert float((gradient * d).sum()) == pytest.approx(slope, rel=1e-6)


@pytest.mark.parametrize("name", COST_WEIGHTS)
def test_the_metric_is_the_curvature_where_the_error_vanishes(name: str) -> None:
    x = random_state(2)
    tracking_cost = TrackingCost(standing(), at_itself(x), COST_WEIGHTS[name])
    gradient, metric = tracking_cost.expand(x)
    assert tracking_cost.value(x) == pytest.approx(0.0, abs=1e-20)
    assert np.abs(gradient).max() < 1e-10
    for seed in range(3):
        d = direction(seed)
        step = 1e-4
        curvature = (
            tracking_cost.value(x + step * d) + tracking_cost.value(x - step * d)
        ) / step**2
        assert float((d * metric.times(d)).sum()) == pytest.approx(curvature, rel=1e-5)
        jacobians = [tracking_cost.expand(x + s * step * d)[0] for s in (1.0, -1.0)]
        rise = (jacobians[0] - jacobians[1]) / (2.0 * step)
        ours = metric.times(d) * standing().active
        assert ours == pytest.approx(rise, abs=1e-4 * np.abs(rise).max())


@pytest.mark.parametrize("name", COST_WEIGHTS)
def test_the_metric_is_positive_definite(name: str) -> None:
    x = random_state(4)
    _, metric = TrackingCost(standing(), at_itself(x), COST_WEIGHTS[name]).expand(x)
    count = x.size
    dense = np.stack([metric.times(row.reshape(x.shape)).ravel() for row in np.eye(count)])
    assert dense == pytest.approx(dense.T, abs=1e-12 * np.abs(dense).max())
    assert np.linalg.eigvalsh(dense).min() > 0.0
    metric.factor()


def test_a_shift_costs_what_it_moves() -> None:
    """A decimetre of everything, over 0.3 s, is half of 0.1² m² times 0.3 s."""
    x = random_state(5)
    tracking_cost = TrackingCost(standing(), at_itself(x), CostWeights(position=1.0))
    far = x.copy()
    far[:, standing().layout.com] += [0.1, 0.0, 0.0]
    assert tracking_cost.value(far) == pytest.approx(0.5 * 0.01 * 0.3)
    shape = TrackingCost(standing(), at_itself(x), CostWeights(shape=1.0))
    assert shape.value(far) == pytest.approx(0.0, abs=1e-20)


def test_markers_span_every_body() -> None:
    points = marker_points(figure())
    for i in range(len(figure().bodies)):
        mine = np.stack([p.place for p in points if p.body == i])
        assert np.linalg.matrix_rank(mine - mine[0], tol=1e-6) >= 2
