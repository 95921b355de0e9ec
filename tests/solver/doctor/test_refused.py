"""Recordings of which nothing can be told are refused in words."""

from dataclasses import replace

import numpy as np
import pytest
from hangtime.devtools.doctor.damages.clock import slowed
from hangtime.solver.analysis.analyse import analyse
from hangtime.solver.data.faults import (
    ClipTooShort,
    FramesFarApart,
    NotComputable,
    ZeroLengthBone,
)
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.doctor.examination.diagnose import diagnose
from hangtime.solver.doctor.finding import FindingKind
from hangtime.tests.helpers.doctored import jump


@pytest.mark.parametrize("count", [1, 2, 4])
def test_a_clip_of_a_few_frames_is_refused_in_words(count: int) -> None:
    with pytest.raises(ClipTooShort):
        diagnose(jump().part(slice(0, count)))


@pytest.mark.parametrize(("frames", "too_short"), [(5, True), (36, True), (37, False)])
def test_a_clip_that_is_too_short_to_be_adapted_is_told(frames: int, too_short: bool) -> None:
    """As the analysis refuses it, of less than 0.3 s."""
    clip = jump().part(slice(0, frames))
    kinds = [finding.kind for finding in diagnose(clip).findings if not finding.kind.note]
    assert kinds == ([FindingKind.TOO_SHORT] if too_short else [])
    if too_short:
        with pytest.raises(ClipTooShort):
            analyse(clip, MotionProblem())


def test_a_clip_is_too_short_by_the_clock_that_is_told() -> None:
    """Its flight of 0.4 s, at four times the rate."""
    fast = slowed(0.25).of(jump().part(slice(90, 170))).recording
    kinds = {finding.kind for finding in diagnose(fast).findings}
    assert FindingKind.TIME_SCALE in kinds
    assert FindingKind.TOO_SHORT not in kinds


def test_frames_of_hours_are_refused_in_words() -> None:
    """A file's frame time of hours would be searched for contacts every hundredth of a second."""
    clip = jump().part(slice(0, 20))
    slow = replace(clip, times=1e6 * clip.times)
    with pytest.raises(FramesFarApart):
        diagnose(slow)
    with pytest.raises(FramesFarApart):
        analyse(slow, MotionProblem())


def test_frames_too_rare_for_a_hop_are_no_motion_but_have_a_diagnosis() -> None:
    """Found by the campaign (seed 4, case 6975): at one frame a second a hop lasts half a minute,
    of which a fit took four."""
    clip = jump()
    rare = replace(clip, times=0.2 * clip.rate * clip.times)
    assert diagnose(rare).findings
    with pytest.raises(FramesFarApart):
        analyse(rare, MotionProblem())


def test_lengths_beyond_all_numbers_are_said_not_to_be_computable() -> None:
    """As one damaged byte of a file may make them."""
    clip = jump().part(slice(0, 20))
    heads = clip.heads.copy()
    heads[:, [bone.name for bone in clip.bones].index("Head")] *= 1e200
    with np.errstate(all="ignore"), pytest.raises(NotComputable):
        diagnose(replace(clip, heads=heads))


def test_a_skeleton_without_lengths_is_refused_with_a_bone_of_it() -> None:
    clip = jump().part(slice(0, 20))
    nowhere = replace(clip, heads=np.repeat(clip.heads[:, :1], len(clip.bones), axis=1))
    with pytest.raises(ZeroLengthBone) as caught:
        diagnose(nowhere)
    assert caught.value.bone == "LeftUpLeg"
