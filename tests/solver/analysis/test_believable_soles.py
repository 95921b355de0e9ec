"""Soles that a person may have, whatever the feet of a recording do."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.solver.analysis.performance import contact_points, perform
from hangtime.solver.body.character import build_character
from hangtime.solver.data.contacts import ContactPoint
from hangtime.solver.data.recording import Recording
from hangtime.tests.helpers.clips import JUMP, load_recording

HIGH = "131_03_hop.bvh"  # the balls of its feet stand 7 cm up, higher than any other's
RUNS = ("run_1.bvh", "run_2.bvh", "run_3.bvh")
JUMPS = (
    JUMP,
    "forward_jump_114cm.bvh",
    "high_jump.bvh",
    "hops_in_place.bvh",
    "fair1_jumping.bvh",
    "cmu1_jumping_jacks.bvh",
)


def points_of(recording: Recording) -> tuple[dict[str, ContactPoint], float]:
    return contact_points(perform(recording, build_character(recording)))


def raised(recording: Recording, height: float) -> Recording:
    return replace(recording, heads=recording.heads + np.array([0.0, 0.0, height]))


def test_the_floor_goes_with_the_recording() -> None:
    """It does not leap, and goes by as much where 0 cannot be the floor."""
    recording, lift = load_recording(HIGH), 0.01
    floors = [points_of(raised(recording, lift * i))[1] for i in range(-16, 13)]
    steps = np.diff(floors)
    assert np.all((steps >= 0.0) & (steps < 2.0 * lift + 1e-9))
    assert steps[:5] == pytest.approx(lift)
    assert steps[-5:] == pytest.approx(lift)


@pytest.mark.parametrize("clip", [HIGH, *RUNS, *JUMPS])
def test_recordings_stand_on_the_world_s_floor(clip: str) -> None:
    """Their balls are 2 to 7 cm up when they stand, and who adds ground puts it at 0."""
    assert points_of(load_recording(clip))[1] == 0.0
