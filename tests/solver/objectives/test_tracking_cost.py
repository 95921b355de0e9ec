"""Tracking cost: its gradient and Hessian against finite differences."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.solver.objectives.joint_price import JointPrice
from hangtime.solver.objectives.motion_metric import motion_target
from hangtime.solver.objectives.tracking_cost import (
    CostWeights,
    TrackingCost,
    TrackingTarget,
    marker_points,
)
from hangtime.solver.transcription.motion import Motion
from hangtime.tests.helpers.toy_problems import figure, places, random_state, standing

COST_WEIGHTS = {
    "fit": CostWeights(
        position=1.0,
        acceleration_time=0.05,
        com_acceleration=0.01,
        force=1e-4,
        friction=1e-3,
        goes_on=True,
    ),
    "adaptation": CostWeights(
        shape=1.0, com=0.02, acceleration_time=0.05, force=3e-3, came_from=10.0
    ),
    "all": CostWeights(
        position=0.7,
        shape=0.4,
        com=0.2,
        acceleration_time=0.1,
        com_acceleration=0.3,
        force=0.02,
        force_rate_time=0.1,
        friction=0.05,
        rest=3.0,
    ),
}


def priced() -> JointPrice:
    """Joints' turns at any price, of hips and knees."""
    random = np.random.default_rng(11).normal(size=(len(figure().bodies), 3, 3))
    turns = 0.1 * random @ np.swapaxes(random, 1, 2)
    turns[0] = 0.0
    return JointPrice(turns, np.ones(len(turns)))


def cost_of(name: str, target: TrackingTarget) -> TrackingCost:
    """The cost with weights by name; an adaptation's has a price of turning joints, and who has all
    weights rests in the first half."""
    price = priced() if name == "adaptation" else None
    times = standing().node_times
    resting = times < times.mean() if name == "all" else None
    return TrackingCost(standing(), target, COST_WEIGHTS[name], price, resting)


def at_itself(x: np.ndarray) -> TrackingTarget:
    return motion_target(Motion(standing(), x, places()))


def direction(seed: int) -> np.ndarray:
    t = standing()
    return np.random.default_rng(70 + seed).normal(size=t.active.shape) * t.active


@pytest.mark.parametrize("name", COST_WEIGHTS)
def test_the_gradient_is_the_value_s_slope(name: str) -> None:
    """The metric of accelerations and rates is taken as fixed: the target has no such errors."""
    x, target = random_state(0), at_itself(random_state(1))
    own = at_itself(x)
    ends = replace(target.ends, rates=own.ends.rates)
    target = replace(target, accelerations=own.accelerations, ends=ends)
    tracking_cost = cost_of(name, target)
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
    tracking_cost = cost_of(name, at_itself(x))
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
    _, metric = cost_of(name, at_itself(x)).expand(x)
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


def test_half_of_a_change_is_measured_by_what_it_takes_of_ranges() -> None:
    """A knee that is turned by 0.2 rad: half of what that moves, and half of its price."""
    x = random_state(5)
    weights, t = CostWeights(shape=1.0, by_range=0.5), standing()
    knee, further = 2, x.copy()
    angle = 3 + figure().joints[knee].dofs.start
    assert t.layout.motion.start == 0
    further[:, angle] += 0.2
    axis = figure().joints[knee].axes.after.T[:, 0]  # in the shank's own frame
    turned = 0.04 * float(axis @ priced().turns[knee] @ axis)
    plain = TrackingCost(t, at_itself(x), weights).value(further)
    both = TrackingCost(t, at_itself(x), weights, priced()).value(further)
    assert both == pytest.approx(0.5 * plain + 0.5 * 0.5 * turned * 0.3)


def test_forces_along_the_target_s_slope_cost_no_friction() -> None:
    """A force of 1 up and 0.3 aside lies along a slope of 0.3, one straight up does not."""
    t, x = standing(), random_state(6)
    target = at_itself(x)
    weights = CostWeights(force=0.0, friction=1.0)
    sloped = replace(target, slope=target.slope + np.array([0.3, 0.0]), forces=0.0 * target.forces)
    cost = TrackingCost(t, sloped, weights)
    forces = {"along": (0.3, 0.0, 1.0), "up": (0.0, 0.0, 1.0)}
    values = {}
    for name, force in forces.items():
        y = x.copy()
        y[:, t.layout.forces] = np.tile(force, t.layout.n_points)
        y[~t.active] = 0.0
        values[name] = cost.value(y)
    assert values["along"] == pytest.approx(0.0, abs=1e-12)
    assert values["up"] > 1e-3


def test_markers_span_every_body() -> None:
    points = marker_points(figure())
    for i in range(len(figure().bodies)):
        mine = np.stack([p.place for p in points if p.body == i])
        assert np.linalg.matrix_rank(mine - mine[0], tol=1e-6) >= 2
