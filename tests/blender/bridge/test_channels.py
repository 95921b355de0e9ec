"""Rotations as Blender's channels, against Blender's own mathematics."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

pytest.importorskip("bpy", reason="mathutils comes with the bpy module")

from hangtime.bridge.armature.channels import EULER_ORDERS, channels, proper
from hangtime.tests.blender.helpers import rigs
from mathutils import Euler, Quaternion, Vector

MODES = ("QUATERNION", "AXIS_ANGLE", *EULER_ORDERS)


def rotation_of(values: np.ndarray, mode: str) -> np.ndarray:
    if mode == "QUATERNION":
        return np.array(Quaternion(values).to_matrix())
    if mode == "AXIS_ANGLE":
        return np.array(Quaternion(Vector(values[1:]), values[0]).to_matrix())
    return np.array(Euler(values, mode).to_matrix())


@pytest.mark.parametrize("mode", MODES)
def test_channels_mean_the_rotations_to_blender_and_never_jump(mode: str) -> None:
    # Three whole turns about a tilting axis, through every gimbal lock.
    time = np.linspace(0.0, 1.0, 600)
    path = np.array(
        [np.array((Quaternion((0.2, 1.0, 0.3 * t), 6 * math.pi * t)).to_matrix()) for t in time]
    )
    values = channels(path, mode)
    again = np.array([rotation_of(v, mode) for v in values])
    np.testing.assert_allclose(again, path, atol=2e-6)
    halves = np.array([rotation_of((a + b) / 2.0, mode) for a, b in pairwise(values)])
    between = proper(path[1:] + path[:-1])
    assert np.abs(halves - between).max() < 0.02


@pytest.mark.parametrize("mode", EULER_ORDERS)
def test_euler_angles_run_straight_through_the_lock(mode: str) -> None:
    angles = np.tile([0.3, 0.3, 0.3], (200, 1))
    angles[:, "XYZ".index(mode[1])] = np.linspace(0.0, 20.0, 200)
    path = np.array([Euler(a, mode).to_matrix() for a in angles])
    np.testing.assert_allclose(channels(path, mode), angles, atol=2e-5)


@pytest.mark.parametrize("mode", EULER_ORDERS)
def test_locked_euler_angles_hold_still(mode: str) -> None:
    middle = [0.0, 0.0, 0.0]
    middle["XYZ".index(mode[1])] = math.pi / 2
    locked = np.tile(np.array(Euler(middle, mode).to_matrix()), (5, 1, 1))
    values = channels(locked, mode)
    assert np.abs(np.diff(values, axis=0)).max() < 1e-6
    np.testing.assert_allclose(rotation_of(values[0], mode), locked[0], atol=1e-6)


@pytest.mark.parametrize("mode", MODES)
def test_channels_start_nearest_to_what_was_there(mode: str) -> None:
    turn = np.array([rigs.swing(np.full((2, 3), 0.7), f).to_matrix() for f in range(9)])
    plain = channels(turn, mode)[0]
    turns = np.array([2 * math.pi, 0.0, -4 * math.pi])
    other = plain + turns if mode in EULER_ORDERS else -plain
    np.testing.assert_allclose(channels(turn, mode, other)[0], other, atol=1e-6)


def test_identity_has_an_axis() -> None:
    np.testing.assert_array_equal(channels(np.eye(3)[None], "AXIS_ANGLE"), [[0, 0, 1, 0]])


def test_proper_removes_scale_shear_mirroring_and_survives_nothing() -> None:
    turn = np.array(rigs.swing(np.full((2, 3), 0.6), 3).to_matrix())
    shear = np.array([[1.0, 0.2, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    matrices = np.array([turn, turn * 3.0, turn @ shear, turn * [-1, 1, 1], np.zeros((3, 3))])
    result = proper(matrices)
    np.testing.assert_allclose(
        result @ result.swapaxes(1, 2), np.tile(np.eye(3), (5, 1, 1)), atol=1e-12
    )
    np.testing.assert_allclose(np.linalg.det(result), 1.0)
    np.testing.assert_allclose(result[:2], [turn, turn], atol=1e-6)
