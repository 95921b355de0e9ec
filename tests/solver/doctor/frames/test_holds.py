"""A pose that is held amid a movement is told as such, and whether time passed meanwhile."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.devtools.doctor.damages.clock import frozen
from hangtime.devtools.doctor.damages.damage import at_rate
from hangtime.devtools.doctor.measure import apart
from hangtime.solver.data.recording import Recording
from hangtime.solver.doctor.examination.diagnose import Diagnosis, diagnose
from hangtime.solver.doctor.examination.repair import repaired
from hangtime.solver.doctor.finding import FindingKind
from hangtime.solver.doctor.frames.holds import HELD, holds
from hangtime.solver.doctor.repairs import MissingFrames, Repairs
from hangtime.tests.helpers.doctored import jump

ALOFT = 1.0  # s, from the clip's beginning


def of_rows(rows: np.ndarray, recording: Recording) -> Recording:
    """The poses at these indices, one after the other."""
    index = np.arange(len(rows))
    return replace(
        recording,
        frames=recording.frames[0] + index,
        times=index / recording.rate,
        heads=recording.heads[rows],
        rotations=recording.rotations[rows],
    )


def alone(diagnosis: Diagnosis, kind: FindingKind) -> None:
    """That nothing else is found, of the clip's clock, ends or contacts either."""
    assert [finding.kind for finding in diagnosis.findings] == [kind]


@pytest.mark.slow
@pytest.mark.parametrize("rate", [30.0, 60.0, 120.0])
def test_frames_put_in_aloft_are_taken_out(rate: float) -> None:
    whole, count = at_rate(jump(), rate), round(0.3 * rate)
    at = round(ALOFT * rate)
    damaged = of_rows(np.insert(np.arange(len(whole.frames)), at, np.full(count, at)), whole)
    diagnosis = diagnose(damaged)
    alone(diagnosis, FindingKind.REPEATED_FRAMES)
    after = round(whole.frames[at])
    assert diagnosis.findings[0].frames == ((after + 1.0, float(after + count)),)
    assert diagnosis.repairs == Repairs(missing=(MissingFrames(after, -count),))
    mended = repaired(damaged, diagnosis.repairs)
    np.testing.assert_array_equal(mended.frames, whole.frames)
    np.testing.assert_allclose(mended.times, whole.times, atol=1e-9)
    assert apart(mended, whole) < 1e-9


@pytest.mark.slow
@pytest.mark.parametrize("rate", [30.0, 60.0, 120.0])
def test_a_pose_held_over_others_aloft_is_filled_in(rate: float) -> None:
    whole, count = at_rate(jump(), rate), round(0.3 * rate)
    rows, at = np.arange(len(whole.frames)), round(ALOFT * rate)
    rows[at + 1 : at + count + 1] = at
    damaged = of_rows(rows, whole)
    diagnosis = diagnose(damaged)
    alone(diagnosis, FindingKind.HELD_FRAMES)
    assert apart(damaged, whole) > 0.05
    assert apart(repaired(damaged, diagnosis.repairs), whole) < 0.015


@pytest.mark.slow
def test_both_are_told_apart_and_mended_together() -> None:
    damaged = frozen(0.1, repeated=True).of(frozen(0.3).of(jump()).recording).recording
    diagnosis = diagnose(damaged)
    kinds = {finding.kind for finding in diagnosis.findings}
    assert kinds == {FindingKind.HELD_FRAMES, FindingKind.REPEATED_FRAMES}
    assert apart(repaired(damaged, diagnosis.repairs), jump()) < 0.015


def test_who_stops_softly_and_stands_still_is_no_damage() -> None:
    """A pause of half a second before and after which all slows down."""
    seconds = jump().times
    eased = np.interp(seconds, [0.0, 0.6, 1.4, seconds[-1]], [0.0, 0.6, 0.6, seconds[-1] - 0.8])
    soft = np.convolve(np.pad(eased, 20, "edge"), np.hanning(41) / np.hanning(41).sum(), "valid")
    places = jump().heads.reshape(len(seconds), -1)
    moved = np.stack([np.interp(soft, seconds, column) for column in places.T], axis=1)
    still = np.broadcast_to(jump().rotations[:1], jump().rotations.shape)
    paused = replace(jump(), heads=moved.reshape(jump().heads.shape), rotations=still)
    steps = np.abs(np.diff(moved, axis=0)).max(axis=1)
    assert (steps < HELD).sum() > 0.25 * jump().rate
    assert holds(paused) == []


@pytest.mark.slow
def test_where_another_take_begins_after_a_hold_is_a_jump() -> None:
    """Nothing lies between the two that could be filled in."""
    rows, at = np.arange(len(jump().frames)), round(ALOFT * jump().rate)
    rows[at + 1 : at + 37] = at
    damaged = of_rows(rows, jump())
    damaged.heads[at + 37 :] += [6.0, 0.0, 0.0]
    kinds = [finding.kind for finding in diagnose(damaged).findings]
    assert FindingKind.JUMP in kinds
    assert FindingKind.HELD_FRAMES not in kinds


def test_frames_that_a_higher_rate_doubles_are_not_taken_out() -> None:
    """Each fifth frame is held, as where 24 frames a second become 30: the clock is right."""
    rows = np.arange(len(jump().frames)) * 4 // 5
    assert not any(each.repeated for each in holds(of_rows(rows, jump())))


def test_remedies_of_gaps_are_joined_and_left_out_one_by_one() -> None:
    lacks, extra = (Repairs(missing=(MissingFrames(*each),)) for each in ((57, 4), (10, -36)))
    both = lacks.joined(extra)
    assert both.missing == (*extra.missing, *lacks.missing)
    assert both.without(extra) == lacks
    assert both.includes(lacks)
