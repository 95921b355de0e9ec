"""Frames that are repeated at a steady beat are told as such, with the rate before, and evened."""

import numpy as np
import pytest
from hangtime.devtools.doctor.damages.clock import converted, held
from hangtime.devtools.doctor.damages.damage import at_rate
from hangtime.devtools.doctor.measure import apart
from hangtime.operators.words.doctor_text import finding_sentence
from hangtime.solver.data.problem import Mend
from hangtime.solver.doctor.examination.repair import repaired
from hangtime.solver.doctor.finding import FindingKind
from hangtime.solver.doctor.frames.rate_conversion import find_conversion
from hangtime.solver.doctor.repairs import MissingFrames, Repairs
from hangtime.tests.helpers.doctored import jump, of_poses


@pytest.mark.parametrize(("rate", "to"), [(24.0, 30.0), (24.0, 60.0), (25.0, 30.0), (30.0, 60.0)])
def test_the_rate_before_is_told_and_poses_come_at_even_intervals(rate: float, to: float) -> None:
    made = converted(rate, to).of(jump())
    (found,) = of_poses(made.recording)
    assert found.kind is FindingKind.CONVERTED_RATE
    assert f"made from {rate:g} frames a second" in finding_sentence(found)
    mended = repaired(made.recording, found.remedy or Repairs())
    np.testing.assert_array_equal(mended.frames, made.recording.frames)
    np.testing.assert_allclose(mended.times, made.recording.times)
    assert apart(mended, made.original) < 0.3 * apart(made.recording, made.original)


@pytest.mark.parametrize("begins", range(1, 5))
def test_it_is_told_wherever_in_the_beat_a_clip_begins(begins: int) -> None:
    made = converted(24.0, 30.0).of(jump()).recording
    (found,) = of_poses(made.part(slice(begins, None)))
    assert found.amount == pytest.approx(24.0)


def test_frames_that_are_held_at_no_beat_are_no_conversion() -> None:
    assert find_conversion(held(6).of(jump()).recording) is None
    made = converted(24.0, 30.0).of(jump()).recording
    at = 33  # amid the flight, beside no frame that is repeated
    made.heads[at], made.rotations[at] = made.heads[at - 1], made.rotations[at - 1]
    assert find_conversion(made) is None


def test_a_clean_clip_of_few_frames_a_second_is_none() -> None:
    assert find_conversion(at_rate(jump(), 24.0)) is None


def test_poses_are_evened_before_frames_are_put_in() -> None:
    made = converted(24.0, 30.0).of(jump()).recording
    evened = repaired(made, Repairs(mend=(Mend.HELD_FRAMES,)))
    both = repaired(made, Repairs(mend=(Mend.HELD_FRAMES,), missing=(MissingFrames(100, 3),)))
    after = both.frames > 103.0
    assert np.abs(both.heads[after] - evened.heads[-after.sum() :]).max() < 1e-3
