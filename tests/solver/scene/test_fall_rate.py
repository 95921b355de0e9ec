"""The frame rate at which a body falls freely."""

from __future__ import annotations

import numpy as np
import pytest
from hangtime.solver.scene.fall_rate import fitting_rate


def flown(rate: float, frames: int = 50) -> np.ndarray:
    """Heights of a body in free flight, filmed at a rate."""
    times = np.arange(frames) / rate
    noise = np.random.default_rng(1).normal(0.0, 0.001, frames)
    return np.asarray(1.0 + 2.0 * times - 0.5 * 9.81 * times**2 + noise)


@pytest.mark.parametrize(("true", "scene"), [(120, 24), (120, 240), (60, 24), (30, 120)])
def test_a_fall_tells_at_which_rate_it_was_filmed(true: int, scene: int) -> None:
    assert fitting_rate(np.arange(50) / scene, flown(true), scene) == true


def test_what_falls_as_it_should_tells_no_other_rate() -> None:
    assert fitting_rate(np.arange(50) / 120.0, flown(120.0), 120.0) is None


def test_what_is_carried_tells_none() -> None:
    times = np.arange(50) / 24.0
    assert fitting_rate(times, np.full(50, 1.3), 24.0) is None
    assert fitting_rate(times, 1.0 + 0.1 * np.sin(9.0 * times), 24.0) is None
