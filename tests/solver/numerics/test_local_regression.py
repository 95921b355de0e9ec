"""Derivatives by local regression: exact on parabolas, smooth on noise."""

import numpy as np
import pytest
from hangtime.solver.numerics.local_regression import derivative

WIDTH = 0.012


@pytest.mark.parametrize("rate", [24, 60, 120, 240])
def test_parabolas_are_met_exactly_up_to_the_ends(rate: int) -> None:
    t = np.arange(0.0, 1.0, 1.0 / rate)
    at = np.array([0.0, 0.013, 0.5, float(t[-1])])
    samples = np.stack([2.0 * t**2 - t, 0.5 * t**2], axis=1)
    found = derivative(t, samples, at, max(WIDTH, 1.2 / rate), 2)
    assert found == pytest.approx(np.array([[4.0, 1.0]] * 4), abs=1e-6)


def test_noise_is_hardly_greater_at_an_end() -> None:
    t = np.arange(0.0, 1.0, 1.0 / 120.0)
    noise = 0.001 * np.random.default_rng(0).normal(size=(len(t), 500))
    end, middle = derivative(t, noise, np.array([0.0, 0.5]), 0.02, 2).std(axis=1)
    assert end < 5.0 * middle  # a cubic's is 18 times as great


@pytest.mark.parametrize("order", [1, 2])
def test_a_moving_wave_has_its_derivatives(order: int) -> None:
    t = np.arange(0.0, 1.0, 1.0 / 120.0)
    wave = np.exp(6.0j * t)[:, None]
    inner = t[10:-10]
    found = derivative(t, wave, inner, WIDTH, order)
    assert found[:, 0] == pytest.approx((6.0j) ** order * np.exp(6.0j * inner), rel=0.01)


def test_noise_of_a_millimetre_stays_below_what_plain_differences_make_of_it() -> None:
    t = np.arange(0.0, 2.0, 1.0 / 120.0)
    noise = 0.001 * np.random.default_rng(0).normal(size=(len(t), 1))
    inner = t[10:-10]
    ours = derivative(t, noise, inner, 0.02, 2).std()
    plain = np.diff(noise[:, 0], 2).std() * 120.0**2
    assert ours < 0.15 * plain


def test_four_samples_are_enough() -> None:
    t = np.arange(4) / 30.0
    found = derivative(t, (t**2)[:, None], t, 0.04, 2)
    assert found == pytest.approx(np.full((4, 1), 2.0), abs=1e-6)
