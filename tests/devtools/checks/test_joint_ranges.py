"""Angles of joints by formulas of their own, against the solver's and against what is known."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hangtime.devtools.checks.joint_ranges import angles, outside, worst_joint
from hangtime.solver.arrays import FloatArray
from hangtime.solver.human.ranges import JointRange, joint_ranges
from hangtime.solver.numerics.rotations import axis_rotation, rotation_matrix
from hangtime.solver.transcription.joint_measures import ConeAngle
from hangtime.tests.helpers.fitted_hop import hop

RANGES = joint_ranges(hop().performance.character, hop().performance.angles)


CONES = [limit for limit in RANGES if isinstance(limit.measure, ConeAngle)]
OTHERS = [limit for limit in RANGES if not isinstance(limit.measure, ConeAngle)]


def turns() -> FloatArray:
    vectors = np.random.default_rng(3).normal(0.0, 0.7, (50, 3))
    return np.stack([rotation_matrix(each) for each in vectors])


@pytest.mark.parametrize("limit", OTHERS, ids=lambda limit: limit.name)
def test_angles_are_those_that_the_solver_bounds(limit: JointRange) -> None:
    apart = angles(limit.measure, turns()) - limit.measure.of(turns())
    np.testing.assert_allclose(np.sin(0.5 * apart), 0.0, atol=1e-7)


@pytest.mark.parametrize("limit", CONES, ids=lambda limit: limit.name)
def test_cones_end_where_the_solver_s_do(limit: JointRange) -> None:
    assert isinstance(limit.measure, ConeAngle)
    found = outside(limit.measure, limit.upper, turns())
    np.testing.assert_allclose(found, limit.beyond(turns()), atol=1e-7)


def test_a_recording_goes_beyond_no_range_that_it_widens() -> None:
    performance = hop().performance
    worst = worst_joint(performance.recording, performance)
    assert worst.degrees == pytest.approx(0.0, abs=1e-6)


def test_a_folded_neck_is_named_with_its_frame_and_degrees() -> None:
    performance = hop().performance
    recording = performance.recording
    turned = recording.rotations.copy()
    head = recording.index("Head")
    turned[5, head] = axis_rotation(0, math.radians(90.0)) @ turned[5, head]
    worst = worst_joint(replace(recording, rotations=turned), performance)
    assert worst.joint.startswith("Neck")
    assert worst.frame == recording.frames[5]
    assert 45.0 < worst.degrees < 90.0
