"""The frame rate at which a body falls freely."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hangtime.solver.analysis.analyse import analyse
from hangtime.solver.data.faults import UnseenSupport
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.data.recording import Recording
from hangtime.solver.scene.fall_rate import fitting_rate, is_pulled_down
from hangtime.tests.helpers.clips import JUMP, load_recording


def flown(rate: float, frames: int = 50) -> np.ndarray:
    """Heights of a body in free flight, filmed at a rate."""
    times = np.arange(frames) / rate
    noise = np.random.default_rng(1).normal(0.0, 0.001, frames)
    return np.asarray(1.0 + 2.0 * times - 0.5 * 9.81 * times**2 + noise)


@pytest.mark.parametrize(("true", "scene"), [(120, 24), (120, 240), (60, 24), (30, 120)])
def test_a_fall_tells_at_which_rate_it_was_filmed(true: int, scene: int) -> None:
    assert fitting_rate(np.arange(50) / scene, flown(true), scene) == true


@pytest.mark.parametrize(("true", "scene"), [(48, 24), (30, 60), (120, 24)])
def test_beside_a_rate_of_ntsc_s_the_others_are_ntsc_s_too(true: int, scene: int) -> None:
    true_rate, scene_rate = true / 1.001, scene / 1.001
    found = fitting_rate(np.arange(50) / scene_rate, flown(true_rate), scene_rate)
    assert found == pytest.approx(true_rate, rel=1e-9)


def test_what_falls_as_it_should_tells_no_other_rate() -> None:
    assert fitting_rate(np.arange(50) / 120.0, flown(120.0), 120.0) is None


def test_what_is_carried_tells_none() -> None:
    times = np.arange(50) / 24.0
    assert fitting_rate(times, np.full(50, 1.3), 24.0) is None
    assert fitting_rate(times, 1.0 + 0.1 * np.sin(9.0 * times), 24.0) is None


@pytest.mark.parametrize(("faster", "pulled"), [(1.0, False), (2.0, True)])
def test_feet_that_walk_would_pull_at_a_rate_that_makes_a_step_a_fall(faster, pulled) -> None:
    """Hips that rise and sink by 5 cm, 1.8 times a second: from 3.2 m/s² down to as much up."""
    times = np.arange(240) / (120.0 * faster)
    heights = 0.95 + 0.025 * np.sin(2.0 * np.pi * 1.8 * faster * times)
    floating = (times * faster > 0.6) & (times * faster < 0.8)
    assert is_pulled_down(times, heights, ~floating) == pulled


def test_a_hops_feet_push_though_contacts_last_a_little_too_long() -> None:
    """Whose flights of 0.4 s begin and end 30 ms within contacts, as these are found."""
    times = np.arange(240) / 120.0
    flying = np.mod(times, 0.8) < 0.4
    heights = 1.0 + np.where(flying, 1.0, -1.0) * 0.5 * 9.81 * 0.4 * np.mod(times, 0.4)
    heights -= np.where(flying, 1.0, -1.0) * 0.5 * 9.81 * np.mod(times, 0.4) ** 2
    in_air = (np.mod(times, 0.8) > 0.03) & (np.mod(times, 0.8) < 0.37)
    assert not is_pulled_down(times, heights, ~in_air)


def told_rates(recording: Recording) -> list[int | None]:
    """The rates that an analysis tells where nothing touches, yet the body does not fall."""
    found = analyse(recording, MotionProblem()).unseen
    return [each.rate for each in found if isinstance(each, UnseenSupport)]


def jump() -> Recording:
    return load_recording(JUMP).window(73, 325)


def test_a_jump_that_is_played_too_slowly_tells_its_rate() -> None:
    assert 120 in told_rates(replace(jump(), times=2.0 * jump().times))


def test_what_falls_unlike_a_true_flight_tells_no_rate() -> None:
    """A hop as on the moon, before a jump that falls as it should at 120 frames a second."""
    u = (jump().times - jump().times[4]) / 0.7
    lifted = 4.0 * 0.15 * np.maximum(u * (1.0 - u), 0.0)  # at 2.4 m/s²
    heads = jump().heads + lifted[:, None, None] * np.array([0.0, 0.0, 1.0])
    assert told_rates(replace(jump(), heads=heads)) == [None]


def test_raised_hands_that_are_slow_by_the_clock_alone_hold_on_to_nothing() -> None:
    """A jump of 0.36 s at 150 frames a second, with the arms up, in a scene of 30."""
    stands, seconds, before = jump(), 0.36, 60  # frames
    flown = np.clip((np.arange(2 * before + 54) - before) / 150.0, 0.0, seconds)
    high = 0.5 * 9.81 * flown * (seconds - flown)
    heads = stands.heads[:1] + high[:, None, None] * np.array([0.0, 0.0, 1.0])
    for side, aside in (("Left", 0.25), ("Right", -0.25)):
        above = heads[:, stands.index("Head")] + [aside, 0.0, 0.35]
        heads[:, stands.index(f"{side}Hand")] = above
    still = np.repeat(stands.rotations[:1], len(heads), axis=0)
    frames = np.arange(len(heads), dtype=float)
    slow = replace(stands, times=frames / 30.0, frames=frames, heads=heads, rotations=still)
    assert told_rates(replace(slow, known=())) == [pytest.approx(150.0, rel=0.05)]
