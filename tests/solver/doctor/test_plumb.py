"""Which way is down, by flights."""

import numpy as np
import pytest
from hangtime.devtools.doctor.damages.whole_body import swaying, turned
from hangtime.solver.analysis.performance import perform
from hangtime.solver.arrays import FloatArray
from hangtime.solver.body.character import build_character
from hangtime.solver.data.constants import UP
from hangtime.solver.data.recording import Recording
from hangtime.solver.doctor.plumb import Plumb, find_plumb
from hangtime.solver.doctor.repairs import Repairs
from hangtime.tests.helpers.clips import load_recording, mocap_path
from hangtime.tests.helpers.doctored import jump, onto, sparse, spun

HOPS = "hops_in_place.bvh"
CLIPS = sorted(path.name for path in mocap_path(HOPS).parent.glob("*.bvh"))


def plumb(recording: Recording) -> Plumb | None:
    return find_plumb(perform(recording, build_character(recording)))


def degrees(slope: FloatArray) -> FloatArray:
    return np.degrees(np.arctan(slope))


@pytest.mark.parametrize("recorded", [jump(), onto(0.3), load_recording(HOPS)])
@pytest.mark.parametrize("every", [1, 4, 5])
def test_a_flight_tells_the_vertical(recorded: Recording, every: int) -> None:
    """At 120, 30 and 24 Hz: to half a degree, and to one."""
    found = plumb(sparse(recorded, every))
    assert found is not None
    assert np.linalg.norm(degrees(found.slope)) < (0.7 if every == 1 else 1.2)
    assert not found.is_sloping


@pytest.mark.parametrize(
    "clip", sorted(path.name for path in mocap_path(HOPS).parent.glob("*.bvh"))
)
def test_no_recording_has_down_elsewhere(clip: str) -> None:
    found = plumb(load_recording(clip))
    assert found is None or np.linalg.norm(degrees(found.slope)) < 0.7


@pytest.mark.parametrize("angle", [-20.0, 5.0, 30.0])
def test_it_turns_with_the_recording(angle: float) -> None:
    level, sloping = plumb(jump()), plumb(turned(jump(), Repairs(tilt=(-angle, 0.0))))
    assert level is not None
    assert sloping is not None
    assert sloping.is_sloping
    assert degrees(sloping.slope - level.slope)[0] == pytest.approx(angle, abs=1.0)


def test_of_who_sways_several_falls_differ() -> None:
    assert plumb(swaying(0.1, 3.0).of(load_recording(HOPS)).recording) is None


def test_who_stands_or_runs_falls_for_too_short_a_time() -> None:
    assert plumb(jump().part(slice(0, 60))) is None
    assert plumb(load_recording("run_2.bvh")) is None


def test_who_twists_about_a_centre_that_is_a_little_off_falls_straight_down() -> None:
    """Less than a centimetre, as tables of masses differ, made a slope of 3.9° of a full twist."""
    recorded = load_recording("high_jump.bvh")
    twisted = spun(recorded, UP, 1.35, 1.85, off=(0.008, 0.0, 0.0))
    found = plumb(twisted)
    assert found is not None
    assert np.linalg.norm(degrees(found.slope)) > 1.6
    assert not found.is_sloping


def test_a_few_frames_tell_nothing() -> None:
    """At 5 Hz a flight has two."""
    assert plumb(sparse(jump(), 24)) is None
