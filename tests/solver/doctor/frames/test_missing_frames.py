"""Frames that are missing are counted, and put in."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.devtools.doctor.damages.clock import gap
from hangtime.devtools.doctor.damages.poses import noisy
from hangtime.devtools.doctor.measure import apart
from hangtime.solver.data.faults import (
    NotBetweenFrames,
)
from hangtime.solver.data.recording import Recording
from hangtime.solver.doctor.examination.diagnose import diagnose
from hangtime.solver.doctor.examination.repair import filled, repaired
from hangtime.solver.doctor.figure import figure_of
from hangtime.solver.doctor.finding import FindingKind
from hangtime.solver.doctor.frames.jumps import find_jumps
from hangtime.solver.doctor.frames.missing import find_dropped, off_cubic
from hangtime.solver.doctor.repairs import MissingFrames, Repairs
from hangtime.tests.helpers.clips import load_recording
from hangtime.tests.helpers.doctored import jump, moved_from


def test_frames_that_are_missing_in_a_row_are_counted_and_no_other_fault_is_told() -> None:
    """The body's leap over them is what they are told by."""
    recording = jump()
    keep = np.delete(np.arange(len(recording.frames)), slice(98, 104))  # in the push
    frames, times = (each[: len(keep)] for each in (recording.frames, recording.times))
    heads, rotations = recording.heads[keep], recording.rotations[keep]
    less = replace(recording, frames=frames, times=times, heads=heads, rotations=rotations)
    (found,) = diagnose(less, mass=70.0).findings
    assert found.kind is FindingKind.DROPPED_FRAMES
    assert found.amount == pytest.approx(6.0, abs=1.0)
    assert found.frames[0][0] <= frames[98] <= found.frames[0][1]
    assert found.remedy is not None
    (missing,) = found.remedy.missing
    assert missing.after == frames[97]


def test_frames_missing_side_by_side_are_each_counted() -> None:
    """Frames 40, 42 and 43: a frame is left between them, both steps to which are too long."""
    keep = np.delete(np.arange(len(jump().frames)), [100, 102, 103])
    size, first = len(keep), jump().frames[0]
    less = replace(
        jump(),
        frames=jump().frames[:size],
        times=jump().times[:size],
        heads=jump().heads[keep],
        rotations=jump().rotations[keep],
    )
    found = find_dropped(less)
    assert found is not None
    assert found.remedy == Repairs(
        missing=(MissingFrames(round(first + 99), 1), MissingFrames(round(first + 100), 2))
    )
    assert apart(repaired(less, found.remedy), jump()) < 1e-4


@pytest.mark.parametrize("at", [8, 12, 16])
def test_a_frame_lost_in_the_noise_of_video_is_put_in_and_nothing_cut(at: int) -> None:
    """Its step of 9 cm was told as a jump, and half the run left out."""
    noise = _noisy("BMC_run.bvh", 0)
    size, keep = len(noise.frames) - 1, np.delete(np.arange(len(noise.frames)), at)
    less = replace(
        noise,
        frames=noise.frames[:size],
        times=noise.times[:size],
        heads=noise.heads[keep],
        rotations=noise.rotations[keep],
    )
    diagnosis = diagnose(less)
    assert FindingKind.JUMP not in {found.kind for found in diagnosis.findings}
    assert diagnosis.repairs.missing == (MissingFrames(round(noise.frames[at - 1]), 1),)


@pytest.mark.parametrize("at", [14, 21])
def test_a_jump_along_the_way_lacks_no_frames_of_the_pose(at: int) -> None:
    noise = _noisy("run_1.bvh", 1)
    way = (noise.heads[at + 1, 0] - noise.heads[at - 2, 0]) * [1.0, 1.0, 0.0]
    heads = noise.heads.copy()
    heads[at:] += 0.1 * way / np.linalg.norm(way)
    jumped = replace(noise, heads=heads)
    assert find_dropped(jumped) is None
    assert find_jumps(jumped, figure_of(jumped)) is not None


def _noisy(name: str, seed: int) -> Recording:
    """A run without its first frames, as one camera has it."""
    recording = load_recording(name)
    run = recording.window(recording.frames[0] + 2.0, recording.frames[-1])
    return noisy(3.0, 1.0).do(run, np.random.default_rng(seed)).recording


def test_frames_that_are_put_in_make_what_follows_later() -> None:
    less, first = gap(6).of(jump()).recording, round(jump().frames[0])
    longer = filled(less, (MissingFrames(first + 20, 2), MissingFrames(first + 50, 4)))
    np.testing.assert_allclose(longer.frames, jump().frames)
    np.testing.assert_allclose(longer.times, jump().times)
    np.testing.assert_allclose(longer.heads[:21], less.heads[:21], atol=1e-12)
    np.testing.assert_allclose(longer.heads[23:53], less.heads[21:51], atol=1e-12)
    np.testing.assert_allclose(longer.heads[57:], less.heads[51:], atol=1e-12)


def test_frames_after_the_last_one_are_not_missing() -> None:
    last = round(jump().frames[-1])
    with pytest.raises(NotBetweenFrames):
        filled(jump(), (MissingFrames(last, 2),))


def test_frames_are_not_put_in_where_they_are_left_out() -> None:
    """They would count among those that are, which then were too few."""
    whole = moved_from(180)
    keep = np.delete(np.arange(len(whole.frames)), [200])
    less = replace(
        whole,
        frames=whole.frames[:-1],
        times=whole.times[:-1],
        heads=whole.heads[keep],
        rotations=whole.rotations[keep],
    )
    diagnosis = diagnose(less)
    kinds = [finding.kind for finding in diagnosis.findings if not finding.kind.note]
    assert kinds == [FindingKind.DROPPED_FRAMES, FindingKind.JUMP]
    np.testing.assert_array_equal(repaired(less, diagnosis.repairs).frames, jump().frames[:180])


def test_products_of_moves_tell_how_far_places_are_from_a_cubic() -> None:
    """As a fit of the cubics themselves does, wherever the places are."""
    rng = np.random.default_rng(4)
    places, instants = (
        5.0 + rng.normal(size=(7, 6)).cumsum(axis=0),
        np.array([0, 1, 2, 5, 6, 7, 8.0]),
    )
    moves = np.diff(places, axis=0)
    (off,) = off_cubic((moves @ moves.T)[:, :, None], instants)
    powers = np.vander(instants, 4)
    left = places - powers @ np.linalg.lstsq(powers, places, rcond=None)[0]
    assert off == pytest.approx(np.linalg.norm(left), rel=1e-9)


def test_an_arm_that_whips_round_tells_of_no_missing_frames() -> None:
    """It alone moves as if two frames were missing, beside a body that stands."""
    heads, at = np.repeat(jump().heads[:1], len(jump().frames), axis=0), 100
    arm = [i for i, bone in enumerate(jump().bones) if bone.name in ("LeftForeArm", "LeftHand")]
    heads[:at, arm], heads[at:-2, arm] = jump().heads[:at, arm], jump().heads[at + 2 :, arm]
    heads[-2:, arm] = jump().heads[-1, arm]
    assert find_dropped(replace(jump(), heads=heads)) is None
