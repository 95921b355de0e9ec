"""What the mouse points at, without Blender."""

from math import pi, radians, tau

import numpy as np
import pytest
from hangtime.operators.drag.rays import (
    Circle,
    Ray,
    along_line,
    angle_about,
    on_plane,
    rounded,
    scaled,
    unwrapped,
)

X, Y, Z = np.eye(3)
GROUND = Circle(np.array([1.0, 2.0, 0.0]), X, Y, 0.5)
DOWN = Ray.of((1.3, 2.4, 5.0), (0.0, 0.0, -2.0))


def towards(point: np.ndarray, viewer: tuple[float, float, float]) -> Ray:
    return Ray.of(viewer, np.asarray(point) - np.asarray(viewer))


def test_a_ray_meets_the_ground() -> None:
    np.testing.assert_allclose(on_plane(DOWN, (0.0, 0.0, 1.0), Z), (1.3, 2.4, 1.0))


@pytest.mark.parametrize("along", [(1.0, 0.0, 0.2), (1.0, 0.0, -0.01)])
def test_what_points_above_the_horizon_or_along_it_meets_no_ground(
    along: tuple[float, float, float],
) -> None:
    assert on_plane(Ray.of((0.0, 0.0, 1.0), along), (0.0, 0.0, 0.0), Z) is None


def test_what_is_met_far_behind_the_point_does_not_count() -> None:
    viewer = Ray.of((0.0, 0.0, 1.0), (1.0, 0.0, -0.2))
    np.testing.assert_allclose(on_plane(viewer, (3.0, 0.0, 0.0), Z, 2.0), (5.0, 0.0, 0.0))
    assert on_plane(viewer, (2.0, 0.0, 0.0), Z, 2.0) is None


def test_a_ray_passes_an_axis_where_it_is_nearest() -> None:
    viewer = Ray.of((3.0, -4.0, 0.7), (0.0, 1.0, 0.0))
    assert along_line(viewer, (0.0, 0.0, 0.2), Z) == pytest.approx(0.5)
    assert along_line(viewer, (0.0, 0.0, 0.2), X) == pytest.approx(3.0)
    assert along_line(viewer, (0.0, 0.0, 0.2), Y) is None


@pytest.mark.parametrize("angle", [-3.0, -1.0, 0.0, 0.4, 2.5])
@pytest.mark.parametrize("viewer", [(0.0, 0.0, 6.0), (4.0, -5.0, 2.0), (1.0, -8.0, 0.05)])
def test_a_ray_through_a_point_of_a_circle_tells_its_angle(
    angle: float, viewer: tuple[float, float, float]
) -> None:
    at = GROUND.centre + GROUND.radius * (np.cos(angle) * X + np.sin(angle) * Y)
    found = angle_about(towards(at, viewer), GROUND, angle + 0.05)
    # seen edge-on it is not told from perspective, which a drag's difference does not mind
    assert found == pytest.approx(angle, abs=1e-9 if viewer[2] > 1.0 else 0.08)


def test_a_circle_seen_from_its_edge_is_turned_left_and_right() -> None:
    viewer = (1.0, -8.0, 0.0)
    last, seen = -pi / 2, []
    for x in np.linspace(1.0, 1.4, 9):  # on the near side, to the right
        last = angle_about(towards(np.array([x, 1.5, 0.0]), viewer), GROUND, last)
        seen.append(last)
    assert np.all(np.diff(seen) > 0.0)
    assert -pi / 2 < seen[-1] < 0.0
    beyond = angle_about(towards(np.array([3.0, 1.5, 0.0]), viewer), GROUND, last)
    assert last < beyond < 0.0


def test_turning_on_and_on_counts_whole_turns() -> None:
    last = 0.0
    for angle in np.linspace(0.0, 1.5 * tau, 40):
        at = GROUND.centre + np.cos(angle) * X + np.sin(angle) * Y
        last = angle_about(towards(at, (1.0, 2.0, 6.0)), GROUND, last)
    assert last == pytest.approx(1.5 * tau)


def test_angles_are_unwrapped_towards_the_last() -> None:
    assert unwrapped(-3.0, 3.0) == pytest.approx(tau - 3.0)
    assert unwrapped(0.1, 2 * tau) == pytest.approx(0.1 + 2 * tau)


@pytest.mark.parametrize("angle", [-3.5, -1.0, 0.0, 0.7, 1.5, 2.0, 3.3, 4.0])
@pytest.mark.parametrize("by", [0.3, 1.0, 2.5])
def test_scaled_tangents_stay_in_their_turn_and_come_back(angle: float, by: float) -> None:
    there = scaled(angle, by)
    assert abs(there - angle) < pi / 2
    assert np.tan(there) == pytest.approx(by * np.tan(angle))
    assert scaled(there, 1.0 / by) == pytest.approx(angle)


def test_directions_are_rounded_to_steps() -> None:
    step = radians(5.0)
    np.testing.assert_allclose(rounded(np.array([0.02, 0.03, -1.0]), step), -Z, atol=1e-12)
    found = rounded(np.array([np.cos(0.5), np.sin(0.5), 0.01]), step)
    assert np.arctan2(found[1], found[0]) == pytest.approx(radians(30.0))
    assert found[2] == pytest.approx(0.0)
    assert np.linalg.norm(found) == pytest.approx(1.0)
