"""Hermite keys: exact on cubics, fitted to samples."""

import numpy as np
from hangtime.bridge.keys.hermite import fitted
from hypothesis import given
from hypothesis import strategies as st

FRAMES = np.arange(61.0)


def wave(frames: np.ndarray, seed: int) -> np.ndarray:
    random = np.random.default_rng(seed)
    rates, phases = random.uniform(0.02, 0.2, (2, 3, 4))
    return np.sin(frames[:, None, None] * rates + 6.0 * phases).sum(axis=2)


def test_a_cubic_is_one_span() -> None:
    t = FRAMES / 60.0
    cubic = np.column_stack([t**3 - t, 2.0 * t**2 + 1.0])
    keys = fitted(cubic, FRAMES, FRAMES[[0, -1]])
    np.testing.assert_allclose(keys.at(FRAMES), cubic, atol=1e-6)
    np.testing.assert_allclose(60.0 * keys.slopes[:, 0], [-1.0, 2.0], atol=1e-4)


@given(st.integers(0, 10_000))
def test_keys_on_all_frames_are_the_samples(seed: int) -> None:
    samples = wave(FRAMES, seed)
    assert np.abs(fitted(samples, FRAMES, FRAMES).at(FRAMES) - samples).max() < 1e-5


@given(st.integers(0, 10_000))
def test_slopes_are_those_of_the_curve_that_is_drawn(seed: int) -> None:
    at = FRAMES[::6]
    keys = fitted(wave(FRAMES, seed), FRAMES, at)
    step = 1e-4
    ahead, back = keys.at(at[1:-1] + step), keys.at(at[1:-1] - step)
    np.testing.assert_allclose((ahead - back) / (2 * step), keys.slopes[1:-1], atol=1e-4)
