"""What a motion looks like to those who draw it, against laws that it must show."""

import numpy as np
import pytest
from hangtime.solver.body.inverse_dynamics import InverseDynamics
from hangtime.solver.data.traces import Traces, scaled_traces
from hangtime.solver.results.trace_sampling import motion_traces, recorded_traces
from hangtime.tests.helpers.fitted_hop import fitted_hop


@pytest.fixture(scope="module")
def seen() -> Traces:
    fit = fitted_hop()
    t = fit.motion.transcription
    dynamics = InverseDynamics(t.character, t.points)
    return motion_traces(fit.motion, fit.performance.recording, fit.schedule, dynamics)


def test_momentum_is_kept_in_flight(seen: Traces) -> None:
    flight = seen.flights[0]
    during = (seen.frames > flight.start + 1) & (seen.frames < flight.end - 1)
    momentum = seen.momentum[during]
    assert np.linalg.norm(momentum, axis=1).min() > 0.5  # the body does turn
    np.testing.assert_allclose(momentum, momentum[:1].repeat(len(momentum), axis=0), atol=0.05)


def test_forces_carry_the_body(seen: Traces) -> None:
    """Their mean over the clip changes the centre of mass's momentum as it does change."""
    rate = 1.0 / np.diff(fitted_hop().performance.times).mean()
    gained = (seen.velocity[-1] - seen.velocity[0]) * seen.weight / 9.81
    total = seen.forces.sum(axis=1)
    pushed = (0.5 * (total[1:] + total[:-1]) / rate).sum(axis=0)
    pushed[2] -= seen.weight * (len(seen.frames) - 1) / rate
    np.testing.assert_allclose(pushed, gained, atol=0.02 * seen.weight)
    flight = seen.flights[0]
    during = (seen.frames > flight.start + 1) & (seen.frames < flight.end - 1)
    assert np.abs(seen.forces[during]).max() == 0.0


def test_a_flights_parabola_is_the_path_of_the_centre_of_mass(seen: Traces) -> None:
    flight = seen.flights[0]
    steps = np.diff(flight.parabola, n=2, axis=0)
    np.testing.assert_allclose(steps, np.tile(steps[:1], (len(steps), 1)), atol=1e-7)
    assert steps[0, 2] < 0.0
    first = np.searchsorted(seen.frames, flight.start)
    assert np.linalg.norm(flight.parabola - seen.com[first], axis=1).min() < 0.05


def test_a_recording_shows_its_figure_and_what_might_touch() -> None:
    performance = fitted_hop().performance
    seen = recorded_traces(performance)
    np.testing.assert_array_equal(seen.heads, performance.centres)
    assert "Left heel" in seen.contacts
    assert seen.points.shape == (len(seen.frames), len(seen.contacts), 3)
    assert seen.forces.size == 0


def test_the_fit_looks_like_its_recording(seen: Traces) -> None:
    was = recorded_traces(fitted_hop().performance)
    assert seen.bones == was.bones
    assert np.sqrt(((seen.tails - was.tails) ** 2).sum(axis=2).mean()) < 0.06
    assert np.abs(seen.velocity - was.velocity).mean() < 0.1


def test_solid_shapes_follow_their_bodies(seen: Traces) -> None:
    heads = {bone: seen.heads[:, i] for i, bone in enumerate(seen.bones)}
    character = fitted_hop().motion.transcription.character
    bone_of = {body.name: body.bone for body in character.bodies}
    assert set(seen.solids) == set(bone_of)
    for i, name in enumerate(seen.solids):
        apart = np.linalg.norm(seen.solid_starts[:, i] - heads[bone_of[name]], axis=1)
        np.testing.assert_allclose(apart, apart[0], atol=1e-9)
        assert apart[0] < 0.2  # side by side where the trunk is wide
        length = np.linalg.norm(seen.solid_ends[:, i] - seen.solid_starts[:, i], axis=1)
        np.testing.assert_allclose(length, length[0], atol=1e-9)


def test_a_larger_figure_has_longer_ways_and_the_same_forces(seen: Traces) -> None:
    twice = scaled_traces(seen, 2.0)
    np.testing.assert_array_equal(twice.heads, 2.0 * seen.heads)
    np.testing.assert_array_equal(twice.solid_radii, 2.0 * seen.solid_radii)
    np.testing.assert_array_equal(twice.flights[0].parabola, 2.0 * seen.flights[0].parabola)
    np.testing.assert_array_equal(twice.forces, seen.forces)
    np.testing.assert_array_equal(twice.frames, seen.frames)
