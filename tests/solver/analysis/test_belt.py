"""Treadmills are told as such; steps over the ground are not."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
from hangtime.solver.analysis.analyse import analyse
from hangtime.solver.data.faults import Treadmill
from hangtime.solver.data.problem import MotionProblem, Unseen
from hangtime.solver.data.recording import Recording
from hangtime.tests.helpers.clips import load_recording

RUN = "run_2.bvh"


def on_a_belt(recording: Recording) -> tuple[Recording, float]:
    """The recording with the hips' mean velocity taken away, and that velocity's size, m/s."""
    hips = recording.heads[:, 0]
    mean = (hips[-1] - hips[0]) / recording.times[-1] * [1.0, 1.0, 0.0]
    moved = recording.heads - (recording.times[:, None] * mean)[:, None]
    return replace(recording, heads=moved), float(np.linalg.norm(mean))


@pytest.mark.slow
def test_a_run_on_a_belt_is_a_treadmill() -> None:
    run = load_recording(RUN)
    assert analyse(run, MotionProblem()).schedule.contacts
    belt, speed = on_a_belt(run)
    (found,) = analyse(belt, MotionProblem()).unseen
    assert isinstance(found, Treadmill)
    assert found.speed == pytest.approx(speed, rel=0.1)
    with pytest.raises(Treadmill):
        analyse(belt, MotionProblem(unseen=Unseen.REFUSE))


def test_feet_that_stay_at_one_height_are_seen_on_a_belt_without_a_warning() -> None:
    """As of a figure without moving bones, of which no frame has lower toes than the others."""
    run = load_recording(RUN)
    still = [np.repeat(each[:1], len(run.times), axis=0) for each in (run.heads, run.rotations)]
    heads = still[0] + run.times[:, None, None] * [2.0, 0.0, 0.0]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        (found,) = analyse(replace(run, heads=heads, rotations=still[1]), MotionProblem()).unseen
    assert isinstance(found, Treadmill)
    assert found.speed == pytest.approx(2.0)
