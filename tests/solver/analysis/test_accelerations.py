"""Accelerations of a recorded centre of mass: what noise in the recording makes of them."""

from dataclasses import replace

import numpy as np
from hangtime.solver.analysis.accelerations import com_acceleration
from hangtime.tests.helpers.fitted_hop import hop


def test_noise_hardly_reaches_level_accelerations() -> None:
    performance, schedule = hop().performance, hop().schedule
    noise = 0.001 * np.random.default_rng(0).normal(size=performance.com.shape)
    noisy = replace(performance, com=performance.com + noise, longer=None)
    plain = replace(performance, longer=None)
    at = performance.times[20:-20]
    change = com_acceleration(noisy, schedule, at) - com_acceleration(plain, schedule, at)
    level, vertical = np.sqrt((change[:, :2] ** 2).mean()), change[:, 2].std()
    assert level < 0.4 * vertical  # three parts in ten, by the widths


def test_in_flight_it_is_gravity() -> None:
    performance, schedule = hop().performance, hop().schedule
    flight = schedule.flights[0]
    at = np.array([0.5 * (flight.start + flight.end)])
    found = com_acceleration(performance, schedule, at)[0]
    assert found.tolist() == [0.0, 0.0, -performance.character.gravity]
