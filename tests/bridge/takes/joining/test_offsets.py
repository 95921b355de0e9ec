"""A blend leaves the take with the speed that the motion has against it, despite single frames."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hangtime.bridge.takes.joining.offsets import beginning, faded, seam_offset
from hangtime.solver.data.recording import PoseTrack

RATE = 120.0
BLEND = 30.0  # frames


def track(places: np.ndarray) -> PoseTrack:
    count = len(places)
    turns = np.tile(np.eye(3), (count, 1, 1, 1))
    return PoseTrack(np.arange(count, dtype=float), ("Hips",), turns, places)


def blended(motion: PoseTrack, take: PoseTrack) -> np.ndarray:
    """Places (31, 3) before the seam, the last frame first: of a take that stood still there."""
    seam = seam_offset(beginning(motion, RATE), beginning(take, RATE))
    away = np.arange(BLEND + 1)
    return faded(track(np.zeros((len(away), 3))), seam, away, BLEND).root_head


def test_a_parabola_is_left_with_its_own_speed() -> None:
    take = track(np.zeros((40, 3)))
    seconds = take.frames[:, None] / RATE
    motion = replace(take, root_head=0.02 + seconds * (0.3, 0.0, -0.1) + 2.0 * seconds**2)
    speed = (blended(motion, take)[0] - blended(motion, take)[1]) * RATE
    # The blend bends from the seam on: over its first frame by less than a thirtieth.
    assert speed == pytest.approx([0.3, 0.0, -0.1], abs=0.01)


@pytest.mark.parametrize("at", [1, 2, 3])
def test_one_frame_that_jumps_in_the_recording_does_not_throw_the_blend(at: int) -> None:
    still = np.tile((0.0, 0.01, 0.0), (40, 1))
    take = np.zeros((40, 3))
    take[at] = 0.006  # m, along all axes
    shown = blended(track(still), track(take))
    fastest = np.abs(np.diff(shown, axis=0)).max() * RATE
    # The fading alone of 1 cm goes at 7.5 cm/s.
    assert fastest < 0.25


def test_a_motion_of_fewer_frames_than_the_take_has_a_speed() -> None:
    short = track(np.linspace(0.0, 0.02, 3)[:, None] * (1.0, 0.0, 0.0))
    rate = seam_offset(beginning(short, RATE), beginning(track(np.zeros((40, 3))), RATE)).place_rate
    assert rate == pytest.approx([-0.01, 0.0, 0.0])
