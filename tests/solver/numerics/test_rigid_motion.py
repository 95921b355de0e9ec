"""Sampled rigid motions: through the samples, smooth in between, and exact where they should be."""

import numpy as np
import pytest
from hangtime.solver.numerics.rigid_motion import Poses, SampledPoses
from hangtime.solver.numerics.rotations import axis_rotation, rotation_matrix

TIMES = np.array([0.0, 0.1, 0.15, 0.3, 0.4, 0.5])
STEP = 1e-6


def tumbling() -> SampledPoses:
    random = np.random.default_rng(5)
    turns = rotation_matrix(np.cumsum(0.7 * random.normal(size=(6, 3)), axis=0))
    return SampledPoses(TIMES, random.normal(size=(6, 3)), turns)


def test_it_goes_through_its_samples() -> None:
    motion = tumbling()
    poses = motion.poses(TIMES)
    np.testing.assert_allclose(poses.shift, motion.positions, atol=1e-12)
    np.testing.assert_allclose(poses.turn, motion.rotations, atol=1e-12)


def test_rates_are_derivatives_and_do_not_jump() -> None:
    motion, inner = tumbling(), TIMES[1:-1]
    at = np.concatenate([np.linspace(0.02, 0.48, 47), inner])
    rates = motion.rates(at)
    for sides in ((1.0, 0.0), (0.0, -1.0)):  # from the right and from the left
        ahead, behind = (motion.poses(at + side * STEP) for side in sides)
        np.testing.assert_allclose(rates.turn, (ahead.turn - behind.turn) / STEP, atol=2e-3)
        np.testing.assert_allclose(rates.shift, (ahead.shift - behind.shift) / STEP, atol=2e-3)


def test_rotations_stay_rotations() -> None:
    turn = tumbling().poses(np.linspace(0.0, 0.5, 101)).turn
    np.testing.assert_allclose(
        turn @ np.swapaxes(turn, 1, 2), np.tile(np.eye(3), (101, 1, 1)), atol=1e-12
    )


def test_a_parabola_is_exact() -> None:
    def path(t: np.ndarray) -> np.ndarray:
        return np.stack([1.5 * t**2, 2.0 * t, np.ones_like(t)], axis=1)

    motion = SampledPoses(TIMES, path(TIMES), np.tile(np.eye(3), (6, 1, 1)))
    between = np.linspace(0.0, 0.5, 33)
    np.testing.assert_allclose(motion.poses(between).shift, path(between), atol=1e-12)


def test_whole_turns_go_on() -> None:
    times = np.arange(0.0, 2.0, 1.0 / 24.0)
    motion = SampledPoses(times, np.zeros((len(times), 3)), axis_rotation(2, 7.0 * times))
    between = np.linspace(0.1, 1.8, 200)
    np.testing.assert_allclose(
        motion.poses(between).turn, axis_rotation(2, 7.0 * between), atol=1e-12
    )


def test_outside_it_stays() -> None:
    motion = tumbling()
    np.testing.assert_array_equal(
        motion.poses(np.array([-1.0, 2.0])).shift, motion.poses(TIMES[[0, -1]]).shift
    )


@pytest.mark.parametrize("count", [1, 3])
def test_poses_after_poses(count: int) -> None:
    random = np.random.default_rng(count)
    one, two = (
        Poses(rotation_matrix(random.normal(size=(count, 3))), random.normal(size=(count, 3)))
        for _ in range(2)
    )
    point = random.normal(size=3)
    np.testing.assert_allclose(two.after(one).of(point), two.of(one.of(point)))
