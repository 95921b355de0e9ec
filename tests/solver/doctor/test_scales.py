"""Size and clock that are both wrong are told at once, and no size hides or feigns a fault."""

from functools import cache

import pytest
from hangtime.devtools.doctor.damages.clock import slowed
from hangtime.devtools.doctor.damages.whole_body import joined, rising, sized
from hangtime.solver.data.recording import Recording
from hangtime.solver.doctor.examination.diagnose import Diagnosis, diagnose
from hangtime.solver.doctor.examination.repair import repaired
from hangtime.solver.doctor.falls import person_factor
from hangtime.tests.helpers.clips import JUMP, load_recording

RATE = 120.0  # Hz
UNSCALED = 17.7  # times too large: a BVH file's units, taken for metres


@cache
def jump() -> Recording:
    return load_recording(JUMP)


def sizes(factor: float) -> Recording:
    return sized(factor, "size").of(jump()).recording


@pytest.mark.parametrize("height", [1.2, 1.5, 1.9])
def test_a_person_keeps_the_height_that_they_have(height: float) -> None:
    assert person_factor(height) == 1.0
    assert person_factor(height / 0.0254) == 0.0254  # in inches


def kinds(diagnosis: Diagnosis) -> list[str]:
    return [finding.kind.value for finding in diagnosis.findings]


@pytest.mark.parametrize(
    "played", [24.0, *(pytest.param(fps, marks=pytest.mark.slow) for fps in (30.0, 60.0))]
)
def test_an_import_without_scale_and_frame_rate_has_two_remedies(played: float) -> None:
    recording = slowed(RATE / played).of(sizes(UNSCALED)).recording
    found = diagnose(recording)
    assert kinds(found) == ["size", "time scale"]
    assert [each.alternative for each in found.findings] == [None, None]
    assert recording.rate / found.repairs.time_scale == pytest.approx(RATE, rel=1e-3)
    assert kinds(diagnose(repaired(recording, found.repairs))) == []


@pytest.mark.slow
@pytest.mark.parametrize("unit", [0.0254, 0.01])
def test_a_child_in_a_files_own_units_stays_a_child(unit: float) -> None:
    """At a grown person's height it would seem to fall as at 100 frames a second."""
    child = load_recording("fair1_jumping.bvh")
    found = diagnose(
        slowed(RATE / 24.0).of(sized(1.0 / unit, "size").of(child).recording).recording
    )
    assert kinds(found) == ["size", "time scale"]
    assert found.repairs.scale == pytest.approx(unit, rel=1e-6)
    assert found.repairs.time_scale == pytest.approx(24.0 / RATE, rel=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize("factor", [0.01, UNSCALED, 100.0])
def test_limits_in_metres_are_those_of_persons(factor: float) -> None:
    assert kinds(diagnose(sizes(factor))) == ["size"]


@pytest.mark.slow
@pytest.mark.parametrize("factor", [0.01, UNSCALED])
def test_a_jump_is_told_at_any_size(factor: float) -> None:
    damaged = sized(factor, "size").of(joined(0.2).of(jump()).recording).recording
    found = {finding.kind.value: finding for finding in diagnose(damaged).findings}
    assert {"jump", "size"} == set(found)
    assert found["jump"].amount == pytest.approx(20.0, rel=0.15)  # cm, as a person's


@pytest.mark.slow
@pytest.mark.parametrize(("clip", "times"), [("BMC_run.bvh", 0.5), ("rokoko_jesse_dance.bvh", 5.0)])
def test_a_frame_rate_that_an_analysis_refuses_is_told(clip: str, times: float) -> None:
    """Falls of a run that is too fast are short, and of a dance they do not agree."""
    recording = slowed(times).of(load_recording(clip)).recording
    found = diagnose(recording)
    assert "time scale" in kinds(found)
    assert found.repairs.time_scale == pytest.approx(1.0 / times, rel=0.01)


def test_a_clock_is_told_of_a_recording_that_rises() -> None:
    damaged = rising(0.1).of(jump()).recording
    found = diagnose(slowed(1.25).of(damaged).recording)
    assert kinds(found) == ["time scale", "rising"]
    assert found.repairs.time_scale == pytest.approx(0.8, rel=1e-3)
    assert found.repairs.rise == pytest.approx(0.1, abs=0.015)  # at the clock that is right


def test_falls_at_a_wrong_clock_that_a_rise_hides_are_no_leaps() -> None:
    """Whose remedy would cut what is after them."""
    found = diagnose(slowed(0.6).of(rising(0.07).of(jump()).recording).recording)
    assert {"time scale", "rising"} <= {*kinds(found)}
    assert "leap" not in kinds(found)
    assert found.repairs.trim_end == 0


def test_a_rise_alone_is_no_wrong_clock() -> None:
    """As its feet leave the lowest floor, the wrong moments seem to be falls."""
    damaged = rising(0.07).of(load_recording("hops_in_place.bvh").window(151, 451)).recording
    faults = [finding for finding in diagnose(damaged).findings if not finding.kind.note]
    assert [fault.kind.value for fault in faults] == ["rising"]
