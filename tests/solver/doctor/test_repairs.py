"""Repairs as they are asked for, one by one."""

import numpy as np
import pytest
from hangtime.devtools.doctor.damages.poses import ended_at_rest, noisy
from hangtime.devtools.doctor.damages.whole_body import rising, sliding
from hangtime.devtools.doctor.measure import apart
from hangtime.solver.data.faults import NotBetweenFrames, NothingLeft
from hangtime.solver.data.problem import Mend, MotionProblem
from hangtime.solver.doctor.examination.repair import as_asked, mended, repaired
from hangtime.solver.doctor.repairs import MissingFrames, Repairs
from hangtime.tests.helpers.doctored import jump


@pytest.mark.parametrize("more", [0, 1000])
def test_leaving_out_every_frame_is_refused(more: int) -> None:
    frames = len(jump().frames)
    assert len(repaired(jump(), Repairs(trim=frames - 1)).frames) == 1
    with pytest.raises(NothingLeft) as told:
        repaired(jump(), Repairs(trim=frames + more))
    assert told.value.frames == frames


def test_frames_beyond_the_last_cannot_be_too_many() -> None:
    first, last = map(int, jump().ends)
    most = Repairs(missing=(MissingFrames(first, 1 - (last - first)),))
    assert len(repaired(jump(), most).frames) == 2
    with pytest.raises(NotBetweenFrames):
        repaired(jump(), Repairs(missing=(MissingFrames(first, first - last),)))


def test_a_single_pose_is_left_as_it_is() -> None:
    pose = jump().part(slice(0, 1))
    assert mended(pose, Repairs(mend=tuple(Mend))) is pose


def test_drift_is_taken_out_from_the_first_frame_that_is_asked_for_on() -> None:
    first, last = jump().frames[[0, -1]].tolist()
    asked = MotionProblem(frames=(first + 60.0, last), drift=(0.24, 0.18), rise=0.1)
    slid = rising(0.1).of(sliding(0.3).of(jump()).recording).recording
    without = as_asked(slid, asked)
    away = without.heads - jump().heads
    np.testing.assert_allclose(away, np.broadcast_to(away[0], away.shape), atol=1e-9)
    np.testing.assert_allclose(without.heads[60], slid.heads[60], atol=1e-9)


def test_a_rest_pose_at_the_end_is_not_smoothed_into_the_rest() -> None:
    noise = noisy(3.0, 1.0).of(jump()).recording
    damaged = ended_at_rest(4).of(noise)
    asked = MotionProblem(frames=damaged.original.ends, mend=(Mend.NOISE,))
    mended = as_asked(damaged.recording, asked)
    assert apart(mended, as_asked(damaged.original, asked)) < 1e-9


def test_repairs_are_left_out_one_by_one() -> None:
    both = Repairs(mend=(Mend.FLIPS, Mend.NOISE), scale=2.0)
    one = Repairs(mend=(Mend.NOISE,))
    assert both.includes(one)
    assert both.without(one) == Repairs(mend=(Mend.FLIPS,), scale=2.0)
    assert not both.without(one).includes(one)
    assert both.without(Repairs(scale=3.0)) == Repairs(mend=(Mend.FLIPS, Mend.NOISE))
