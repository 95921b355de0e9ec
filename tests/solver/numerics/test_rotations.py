"""Rotation helpers against scipy's Rotation."""

import numpy as np
import pytest
from hangtime.solver.numerics.rotations import (
    angles_between,
    axis_rotation,
    cross_matrix,
    mean_rotation,
    perpendicular,
    rotation_matrix,
    rotation_vector,
    unit,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

ANGLES = (0.0, 1e-12, 1e-8, 1e-4, 0.1, 1.0, 2.0, np.pi - 1e-4, np.pi - 1e-8)
vectors = st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda v: np.linalg.norm(v) > 1e-3)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_axis_rotations(axis: int) -> None:
    angles = np.linspace(-4.0, 4.0, 12).reshape(3, 4)
    theirs = Rotation.from_euler("xyz"[axis], angles.reshape(-1, 1)).as_matrix().reshape(3, 4, 3, 3)
    assert axis_rotation(axis, angles) == pytest.approx(theirs, abs=1e-14)


@pytest.mark.parametrize("angle", ANGLES)
@settings(max_examples=15)
@given(vectors)
def test_vectors_round_trip_at_small_and_half_turns(
    angle: float, axis: tuple[float, float, float]
) -> None:
    vector = angle * unit(np.array(axis))
    R = rotation_matrix(vector)
    assert pytest.approx(Rotation.from_rotvec(vector).as_matrix(), abs=1e-14) == R
    assert rotation_vector(R) == pytest.approx(vector, abs=1e-10)


@settings(max_examples=15)
@given(vectors)
def test_a_half_turn_has_either_axis(axis: tuple[float, float, float]) -> None:
    R = rotation_matrix(np.pi * unit(np.array(axis)))
    found = rotation_vector(R)
    assert np.linalg.norm(found) == pytest.approx(np.pi, abs=1e-12)
    assert rotation_matrix(found) == pytest.approx(R, abs=1e-12)


def test_leading_axes_are_kept() -> None:
    R = Rotation.random(6, random_state=1).as_matrix().reshape(2, 3, 3, 3)
    assert rotation_matrix(rotation_vector(R)) == pytest.approx(R, abs=1e-12)


def test_cross_matrix() -> None:
    a, b = np.random.default_rng(0).normal(size=(2, 5, 3))
    assert np.einsum("tij,tj->ti", cross_matrix(a), b) == pytest.approx(np.cross(a, b), abs=1e-15)


def test_mean_rotation_of_opposite_turns_is_none() -> None:
    vectors = np.array([[0.4, 0.1, 0.0], [-0.4, -0.1, 0.0]])
    assert mean_rotation(rotation_matrix(vectors)) == pytest.approx(np.eye(3), abs=1e-14)


def test_mean_rotation_is_proper_where_the_average_vanishes() -> None:
    turns = axis_rotation(0, np.linspace(0.0, 2.0 * np.pi, 17)[:-1])
    mean = mean_rotation(turns)
    assert mean @ mean.T == pytest.approx(np.eye(3), abs=1e-12)
    assert np.linalg.det(mean) == pytest.approx(1.0)


@settings(max_examples=20)
@given(vectors)
def test_perpendicular(axis: tuple[float, float, float]) -> None:
    v = unit(np.array(axis))
    assert perpendicular(v) @ v == pytest.approx(0.0, abs=1e-14)
    assert np.linalg.norm(perpendicular(v)) == pytest.approx(1.0)


def test_angles_between_are_the_turns_that_lead_there() -> None:
    random = np.random.default_rng(0)
    axes = random.normal(size=(50, 3))
    turns = np.concatenate([random.uniform(0.0, np.pi, 49), [1e-7]])
    first = rotation_matrix(random.normal(size=(50, 3)))
    second = rotation_matrix(turns[:, None] * axes / np.linalg.norm(axes, axis=1, keepdims=True))
    assert angles_between(first, first @ second) == pytest.approx(turns, rel=1e-6, abs=1e-12)
