"""Noise of video capture is smoothed."""

import numpy as np
import pytest
from hangtime.devtools.doctor.damages.damage import at_rate
from hangtime.devtools.doctor.damages.poses import noisy
from hangtime.devtools.doctor.measure import apart
from hangtime.solver.data.problem import Mend
from hangtime.solver.data.recording import Recording
from hangtime.solver.doctor.examination.repair import repaired
from hangtime.solver.doctor.noise import WIDTH, find_noise, reach, smoothed
from hangtime.solver.doctor.repairs import Repairs
from hangtime.solver.numerics.rotations import rotation_matrix, rotation_vector
from hangtime.tests.helpers.doctored import figure, jump


@pytest.mark.parametrize(("rate", "left"), [(30.0, 0.6), (60.0, 0.5), (120.0, 0.4)])
def test_noise_of_video_capture_is_smoothed(rate: float, left: float) -> None:
    """The more frames a second, the better; by what is left at the body's joints."""
    damaged = noisy(3.0, 1.0, rate).of(jump())
    found = find_noise(damaged.recording, figure())
    assert found is not None
    assert found.remedy is not None
    smooth = repaired(damaged.recording, found.remedy)

    def off(recording: Recording) -> float:
        away = (recording.heads - damaged.original.heads)[:, figure().bones]
        return float(np.sqrt(np.mean(np.sum(away**2, axis=-1))))

    assert off(smooth) < left * off(damaged.recording)


@pytest.mark.parametrize("rate", [30.0, 120.0])
def test_smoothing_leaves_what_is_smooth(rate: float) -> None:
    clean = at_rate(jump(), rate)
    assert apart(repaired(clean, Repairs(mend=(Mend.NOISE,))), clean) < 0.005


def test_each_frame_is_the_value_of_a_cubic_through_its_neighbours() -> None:
    """As solved frame by frame, at both ends, too."""
    damaged = noisy(3.0, 1.0, 30.0).of(jump()).recording
    smooth = smoothed(damaged, figure())
    far, hips = reach(damaged.rate), figure().bones[0]
    assert damaged.bones[hips].parent < 0
    for t in (0, 1, far, len(damaged.frames) // 2, len(damaged.frames) - 1):
        near = np.arange(max(t - far, 0), min(t + far + 1, len(damaged.frames)))
        u = (near - t) / (WIDTH * damaged.rate)
        root = np.exp(-0.25 * u**2)
        here = damaged.rotations[t, hips]
        turns = rotation_vector(here.T @ damaged.rotations[near, hips])
        around = np.hstack([damaged.heads[near, hips], turns])
        cubic = np.linalg.lstsq(
            root[:, None] * u[:, None] ** np.arange(4), root[:, None] * around, rcond=None
        )
        place, turn = np.split(cubic[0][0], 2)
        np.testing.assert_allclose(smooth.heads[t, hips], place, atol=1e-9)
        np.testing.assert_allclose(
            smooth.rotations[t, hips], here @ rotation_matrix(turn), atol=1e-9
        )
