"""Joint axes chosen from a clip: no gimbal lock, and joints that follow what was recorded."""

import numpy as np
import pytest
from hangtime.solver.arrays import FloatArray
from hangtime.solver.body.joint_axes import (
    JointAxes,
    ball_axes,
    half_sphere,
    hinge_axes,
    middle_sine,
    residual_angle,
    universal_axes,
)
from hangtime.solver.numerics.rotations import axis_rotation, rotation_matrix, unit
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import ArrayLike

TIME = np.linspace(0.0, 1.0, 201)
TURN = 2.0 * np.pi * TIME
WOBBLE = 0.25 * np.sin(9.0 * TIME)
DIRECTIONS = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.6, -0.64, 0.48])

seeds = st.integers(0, 2**31)


def about(axis: ArrayLike, angle: FloatArray) -> FloatArray:
    return rotation_matrix(np.asarray(angle)[:, None] * unit(np.asarray(axis, dtype=float)))


def smooth_angles(random: np.random.Generator, size: float) -> FloatArray:
    """(T,) a smooth random angle of at most about `size` rad."""
    return np.asarray(size * np.sin(random.uniform(3.0, 9.0) * TIME + random.uniform(0.0, 6.0)))


def somersault(turn: FloatArray, twist: FloatArray) -> FloatArray:
    """Somersault about y with a twist about the body's own z, tilting a little on the way."""
    tilt = axis_rotation(0, 0.2 * np.sin(2.0 * np.pi * TIME))
    return tilt @ axis_rotation(1, turn) @ axis_rotation(2, twist)


def check_ball(axes: JointAxes, R: FloatArray, largest_middle: float) -> FloatArray:
    angles = axes.angles(R)
    assert np.abs(axes.rotation(angles) - R).max() < 1e-9
    assert np.abs(angles[:, 1]).max() < np.radians(largest_middle)
    turned = np.abs(np.diff(angles, axis=0)).max()
    assert turned < 0.5  # no leap of half or whole turns between frames
    return angles


TUMBLES = {
    "somersault": somersault(TURN, 0.0 * TIME),
    "double somersault": somersault(2.0 * TURN, 0.0 * TIME),
    "twist": somersault(0.3 * np.sin(3.0 * TIME), TURN),
    "somersault with twist": somersault(TURN, TURN),
    "back somersault with half twist": somersault(-TURN, 0.5 * TURN),
}


@pytest.mark.parametrize("name", TUMBLES)
@pytest.mark.parametrize("turned", [0, 1])
def test_tumbling_stays_clear_of_gimbal_lock(name: str, turned: int) -> None:
    frame = rotation_matrix(np.array([0.4, -1.1, 0.7])) if turned else np.eye(3)
    R = frame @ TUMBLES[name]
    angles = check_ball(ball_axes(R), R, 60.0)
    assert np.abs(angles[-1] - angles[0]).max() > np.pi  # whole turns add up, none is lost


@pytest.mark.parametrize("name", [*TUMBLES, "moderate", "hardly any"])
def test_the_pair_found_is_the_best_of_all(name: str) -> None:
    sizes = {"moderate": 1.2, "hardly any": 0.05}
    R = TUMBLES.get(name)
    if R is None:
        random = np.random.default_rng(0)
        angles = [smooth_angles(random, sizes[name]) for _ in range(3)]
        R = rotation_matrix(np.stack(angles, axis=1))
    R = R[::3]  # few enough that the search looks at all
    axes, directions = ball_axes(R), half_sphere(180)
    found = middle_sine(R, axes.before[:, 0], axes.after[2])
    turned = np.swapaxes(R @ directions.T, 1, 2)  # (T, W, 3)
    best = np.max([np.abs(directions @ each.T) for each in turned], axis=0).min()
    assert found == pytest.approx(best, abs=1e-9)


def test_preferred_axes_stand_while_they_serve() -> None:
    u, w = np.array([0.0, 0.0, 1.0]), np.array([0.0, 1.0, 0.0])
    calm = rotation_matrix(0.3 * np.stack([np.sin(TIME), np.cos(TIME), TIME], axis=1))
    axes = ball_axes(calm, preferred=(u, w))
    assert axes.before[:, 0] == pytest.approx(u)
    assert axes.after[2] == pytest.approx(w, abs=1e-12)
    check_ball(axes, calm, 45.0)
    tumble = TUMBLES["somersault"] @ axis_rotation(0, 1.2)  # leads the preferred pair into lock
    spoilt = ball_axes(about([1.0, 0.0, 0.0], TURN), preferred=(u, w))
    check_ball(spoilt, about([1.0, 0.0, 0.0], TURN), 45.0)
    check_ball(ball_axes(tumble, preferred=(u, w)), tumble, 60.0)


@settings(max_examples=20)
@given(seeds)
def test_any_moderate_ball_joint_round_trips(seed: int) -> None:
    random = np.random.default_rng(seed)
    vector = np.stack([smooth_angles(random, 0.8) for _ in range(3)], axis=1)
    R = rotation_matrix(random.normal(size=3)) @ rotation_matrix(vector)
    check_ball(ball_axes(R), R, 75.0)


def test_a_joint_that_never_moves_has_axes() -> None:
    R = np.broadcast_to(rotation_matrix(np.array([2.0, 1.0, -1.0])), (10, 3, 3))
    axes = ball_axes(R)
    assert np.abs(axes.rotation(axes.angles(R)) - R).max() < 1e-9


@settings(max_examples=20)
@given(seeds)
def test_a_hinge_with_a_skew_axis_is_followed(seed: int) -> None:
    random = np.random.default_rng(seed)
    expected = unit(random.normal(size=3))
    skew = unit(expected + 0.25 * random.normal(size=3))
    R = rotation_matrix(random.normal(size=3)) @ about(skew, 0.8 + smooth_angles(random, 0.9))
    axes = hinge_axes(R, expected)
    assert residual_angle(axes, R) < np.radians(0.3)
    assert axes.after[0] @ skew > np.cos(np.radians(1.0))
    assert np.ptp(axes.angles(R)[:, 0]) > 0.5  # it bends by what the recording bends


def test_a_hinge_may_bend_through_more_than_half_a_turn() -> None:
    axis = unit(np.array([0.1, 1.0, 0.0]))
    R = about(axis, np.linspace(0.0, 3.0 * np.pi, 100))
    axes = hinge_axes(R, np.array([0.0, 1.0, 0.0]))
    assert residual_angle(axes, R) < np.radians(0.1)  # the expected axis weighs a little
    assert np.ptp(axes.angles(R)[:, 0]) == pytest.approx(3.0 * np.pi, abs=1e-3)


@pytest.mark.parametrize("expected", DIRECTIONS)
def test_a_hinge_that_hardly_bends_falls_back_to_the_expected_axis(expected: list[float]) -> None:
    axis = np.array(expected)
    noise = 0.002 * np.random.default_rng(3).normal(size=(200, 3))
    found = hinge_axes(rotation_matrix(noise), axis)
    assert found.after[0] @ axis > np.cos(np.radians(2.0))


@settings(max_examples=20)
@given(seeds)
def test_a_universal_joint_finds_both_axes(seed: int) -> None:
    random = np.random.default_rng(seed)
    u, v = unit(random.normal(size=(2, 3)))
    v = unit(v - u * (u @ v))
    mean = rotation_matrix(random.normal(size=3))
    a, b = smooth_angles(random, 0.6), smooth_angles(random, 0.5)
    R = about(u, a) @ mean @ about(mean.T @ v, b)
    expected = [unit(mean.T @ d + 0.2 * random.normal(size=3)) for d in (u, v)]
    expected[1] = unit(expected[1] - expected[0] * (expected[0] @ expected[1]))
    axes = universal_axes(R, (expected[0], expected[1]))
    assert axes.before.T @ axes.before == pytest.approx(np.eye(3), abs=1e-12)
    assert axes.after.T @ axes.after == pytest.approx(np.eye(3), abs=1e-12)
    assert residual_angle(axes, R) < np.radians(3.0)  # the expected axes weigh a little


def test_a_universal_joint_that_hardly_moves_falls_back_to_the_expected_axes() -> None:
    noise = 0.002 * np.random.default_rng(4).normal(size=(200, 3))
    first, second = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
    axes = universal_axes(rotation_matrix(noise), (first, second))
    pair = {int(np.argmax(np.abs(d))) for d in (axes.before[:, 0], axes.after[1])}
    assert pair == {0, 2}
    assert residual_angle(axes, rotation_matrix(noise)) < 0.004


@settings(max_examples=20)
@given(seeds, st.integers(1, 3))
def test_angles_of_a_joint_s_own_rotations_come_back(seed: int, dofs: int) -> None:
    random = np.random.default_rng(seed)
    before, after = rotation_matrix(random.normal(size=(2, 3)))
    angles = np.stack([smooth_angles(random, 1.2) for _ in range(dofs)], axis=1)
    axes = JointAxes(dofs, before, after)
    assert axes.angles(axes.rotation(angles)) == pytest.approx(angles, abs=1e-9)


@pytest.mark.parametrize("dofs", [1, 2, 3])
def test_angles_do_not_depend_on_where_arrays_lie_in_memory(dofs: int) -> None:
    random = np.random.default_rng(0)
    R = rotation_matrix(random.normal(0.0, 0.4, (271, 3)))
    axes = JointAxes(dofs, *rotation_matrix(random.normal(size=(2, 3))))
    first = axes.angles(R)
    memory = [np.empty(0)] * 50  # other arrays, made and freed, so that the heap is ever another
    for size in random.integers(1, 4000, 500):
        memory[random.integers(len(memory))] = np.empty(size)
        assert np.array_equal(axes.angles(R), first)
