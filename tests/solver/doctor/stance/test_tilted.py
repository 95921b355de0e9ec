"""A floor that slopes, as of a camera that was not level."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.devtools.doctor.damages.whole_body import rising, swaying, tilted
from hangtime.devtools.doctor.measure import apart
from hangtime.solver.analysis.performance import perform
from hangtime.solver.body.character import build_character
from hangtime.solver.data.recording import Recording
from hangtime.solver.doctor.examination.diagnose import diagnose
from hangtime.solver.doctor.examination.ground import beneath
from hangtime.solver.doctor.examination.repair import repaired
from hangtime.solver.doctor.figure import figure_of
from hangtime.solver.doctor.finding import Finding, FindingKind
from hangtime.solver.doctor.repairs import Repairs, UpAxis
from hangtime.solver.doctor.stance.tilted import find_tilt
from hangtime.solver.doctor.upright import turn_upright
from hangtime.tests.helpers.clips import load_recording
from hangtime.tests.helpers.doctored import climbed, jump, onto

RUN, HOPS = "run_2.bvh", "131_03_hop.bvh"


def told(recording: Recording) -> Finding | None:
    performance = perform(recording, build_character(recording))
    return find_tilt(performance, figure_of(recording), beneath(recording, ()))


@pytest.mark.parametrize("angle", [-3.0, -1.5, 1.5, 3.0])
@pytest.mark.parametrize("recorded", [jump(), load_recording(RUN)])
def test_a_slope_is_told_and_turned_level(recorded: Recording, angle: float) -> None:
    damaged = tilted(angle).of(recorded)
    found = told(damaged.recording)
    assert found is not None
    assert (found.kind, found.remedy is None) == (FindingKind.TILTED, False)
    assert found.amount == pytest.approx(abs(angle), abs=0.3)
    assert apart(repaired(damaged.recording, found.remedy or Repairs()), damaged.original) < 0.01


@pytest.mark.parametrize("angle", [-8.0, 3.0, 25.0])
@pytest.mark.parametrize("clip", ["high_jump.bvh", "hops_in_place.bvh"])
def test_on_one_spot_falls_tell_the_slope(clip: str, angle: float) -> None:
    damaged = tilted(angle).of(load_recording(clip))
    found = told(damaged.recording)
    assert found is not None
    assert found.amount == pytest.approx(abs(angle), abs=0.5)
    assert apart(repaired(damaged.recording, found.remedy or Repairs()), damaged.original) < 0.01


@pytest.mark.parametrize("recorded", [jump(), load_recording(RUN)])
def test_a_camera_may_be_far_off_the_level(recorded: Recording) -> None:
    """Falls tell it of the jump; of the run, how the body leans."""
    damaged = tilted(20.0).of(recorded)
    diagnosis = diagnose(damaged.recording)
    assert [finding.kind for finding in diagnosis.findings] == [FindingKind.TILTED]
    assert apart(repaired(damaged.recording, diagnosis.repairs), damaged.original) < 0.01


@pytest.mark.parametrize("clip", ["hops_in_place.bvh", "forward_jump_116cm.bvh"])
def test_a_steep_slope_is_no_wrong_clock(clip: str) -> None:
    """By how fast bodies fall downwards alone it was, from 26° on."""
    damaged = tilted(28.0).of(load_recording(clip))
    diagnosis = diagnose(damaged.recording)
    told = {finding.kind for finding in diagnosis.findings if not finding.kind.note}
    assert told == {FindingKind.TILTED}
    assert apart(repaired(damaged.recording, diagnosis.repairs), damaged.original) < 0.01


def test_where_no_ball_stands_falls_tell_the_slope_alone() -> None:
    """It ended in a traceback."""
    hops = tilted(6.0).of(load_recording("hops_in_place.bvh")).recording
    away = hops.times[:, None, None] * np.array([1.0, 0.0, 0.0])
    found = told(replace(hops, heads=hops.heads + away))
    assert found is not None
    assert found.amount == pytest.approx(6.0, abs=0.7)


def test_who_jumps_on_a_box_falls_as_far_off_the_level() -> None:
    damaged = tilted(8.0).of(onto(0.3))
    found = told(damaged.recording)
    assert found is not None
    assert found.amount == pytest.approx(8.0, abs=0.5)


@pytest.mark.parametrize(
    ("recorded", "slope"), [(jump(), 0.05), (load_recording(RUN), 0.15), (jump(), 0.3)]
)
def test_on_a_true_ramp_nobody_falls_or_leans_along_it(recorded: Recording, slope: float) -> None:
    along = recorded.heads[:, figure_of(recorded).bones[0], :2]
    way = (along[-1] - along[0]) / np.linalg.norm(along[-1] - along[0])
    up = slope * (along @ way)[:, None, None] * np.array([0.0, 0.0, 1.0])
    assert told(replace(recorded, heads=recorded.heads + up)) is None


@pytest.mark.parametrize("clip", ["high_jump.bvh", "forward_jump_116cm.bvh", "hops_in_place.bvh"])
def test_who_sways_is_on_no_slope(clip: str) -> None:
    """Its falls are bent by 2.6°."""
    assert told(swaying(0.1, 3.0).of(load_recording(clip)).recording) is None


@pytest.mark.parametrize("angle", [-1.5, 1.5])
def test_of_a_jump_on_a_slope_nothing_else_is_told(angle: float) -> None:
    """It was told to have the weight beside its feet."""
    diagnosis = diagnose(tilted(angle).of(jump()).recording)
    assert [finding.kind for finding in diagnosis.findings] == [FindingKind.TILTED]


@pytest.mark.parametrize(
    ("name", "metres"), [*((RUN, each) for each in (0.03, 0.05, 0.1, 0.2)), (HOPS, 0.1)]
)
def test_a_kerb_and_a_box_are_no_slope(name: str, metres: float) -> None:
    assert told(climbed(load_recording(name), metres, (0.5,))) is None


@pytest.mark.parametrize("metres", [0.04, 0.05, 0.06])
def test_of_few_stances_it_counts_how_many_a_plane_is_near_anyway(metres: float) -> None:
    """A run of four, the first below a kerb: some plane leaves a third of how they differ."""
    assert told(climbed(load_recording(RUN), metres, (0.2,))) is None


@pytest.mark.parametrize("metres", [-0.05, 0.03, 0.05, 0.08])
def test_a_mat_to_jump_on_is_no_slope(metres: float) -> None:
    """Two places are on some plane, but the fall is not along it."""
    assert told(onto(metres)) is None


def test_a_box_to_jump_on_and_stairs_are_no_slope() -> None:
    assert told(climbed(jump(), 0.2, (0.5,))) is None
    assert told(climbed(load_recording(RUN), 0.15, (0.2, 0.4, 0.6, 0.8))) is None


@pytest.mark.parametrize("speed", [-0.1, 0.05, 0.1])
def test_a_body_that_drifts_upwards_is_on_no_slope(speed: float) -> None:
    """Within a stance its feet rise, which on a slope they do not."""
    assert told(rising(speed).of(jump()).recording) is None


def test_a_slope_is_counted_from_where_the_figure_is_upright() -> None:
    turn = turn_upright(Repairs(UpAxis.Y, tilt=(3.0, 0.0)))
    np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-12)
    slope = np.array([np.cos(np.radians(3.0)), np.sin(np.radians(3.0)), 0.0])  # Y is up
    np.testing.assert_allclose(turn @ slope, [1.0, 0.0, 0.0], atol=1e-12)
