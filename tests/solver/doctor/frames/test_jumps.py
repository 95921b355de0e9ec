"""Jumps and leaps part a clip, and the longest part is kept."""

from dataclasses import replace

import pytest
from hangtime.devtools.doctor.damages.poses import ragged
from hangtime.solver.analysis.performance import perform
from hangtime.solver.body.anatomy import Part
from hangtime.solver.doctor.examination.diagnose import diagnose
from hangtime.solver.doctor.examination.repair import repaired
from hangtime.solver.doctor.falls import find_leaps
from hangtime.solver.doctor.finding import FindingKind
from hangtime.solver.doctor.repairs import Repairs
from hangtime.tests.helpers.doctored import character, figure, jump, moved_from


def test_a_leap_of_the_whole_body_is_named_and_left_out() -> None:
    """Lost by capture for its first tenth of a second, 12 cm too low."""
    lowered = jump().heads.copy()
    lowered[:12, :, 2] -= 0.12
    leapt = perform(replace(jump(), heads=lowered), character())
    found = find_leaps(leapt)
    assert found is not None
    assert found.amount > 3.0
    first, last = found.frames[0]
    begun = jump().frames[0]
    assert first - 10 <= begun + 12 <= last + 10
    assert find_leaps(perform(jump(), character())) is None


@pytest.mark.slow
@pytest.mark.parametrize(
    ("at", "kept"),
    [((60,), (60, 252)), ((180,), (0, 179)), ((40, 200), (40, 199)), ((200, 230), (0, 199))],
)
def test_where_takes_were_joined_the_longest_part_is_kept(at, kept) -> None:
    diagnosis = diagnose(moved_from(*at))
    (found,) = diagnosis.findings
    assert found.kind is FindingKind.JUMP
    assert found.remedy == Repairs(trim=kept[0], trim_end=252 - kept[1])
    mended = repaired(moved_from(*at), diagnosis.repairs)
    assert (mended.frames[0], mended.frames[-1]) == tuple(jump().frames[list(kept)])
    assert [f for f in diagnose(mended).findings if not f.kind.note] == []


@pytest.mark.slow
def test_what_a_cut_leaves_holds_no_jump() -> None:
    """Beside the longer first step the second one is nothing, until that is left out."""
    heads = jump().heads.copy()
    heads[:20, :, 0] -= 0.1
    heads[:19, :, 0] -= 0.12
    found = diagnose(replace(jump(), heads=heads))
    assert [f.kind for f in found.findings if not f.kind.note] == [FindingKind.JUMP]
    assert found.repairs.trim == 20
    left = repaired(replace(jump(), heads=heads), found.repairs)
    assert not [f for f in diagnose(left).findings if not f.kind.note]


def test_of_a_clip_that_is_cut_everywhere_no_part_is_worth_keeping() -> None:
    (found,) = (f for f in diagnose(moved_from(*range(30, 250, 30))).findings if not f.kind.note)
    assert found.kind is FindingKind.JUMP
    assert found.remedy is None


def test_what_is_left_out_for_one_fault_is_left_out_for_all() -> None:
    """The rest pose alone is less than what is before the jump."""
    heads, rotations = moved_from(60).heads.copy(), jump().rotations.copy()
    heads[:3] = [bone.head for bone in jump().bones]
    rotations[:3] = [bone.rotation for bone in jump().bones]
    diagnosis = diagnose(replace(jump(), heads=heads, rotations=rotations))
    kinds = [finding.kind for finding in diagnosis.findings if not finding.kind.note]
    assert kinds == [FindingKind.BIND_POSE, FindingKind.JUMP]
    assert diagnosis.repairs.trim == 60


@pytest.mark.slow
@pytest.mark.parametrize("frames", [3, 5, 8, 15])
def test_an_end_at_which_a_bone_jumps_about_is_left_out(frames: int) -> None:
    """None of its steps stands out from the others."""
    findings = diagnose(ragged(frames).of(jump()).recording).findings
    (found,) = (each for each in findings if each.kind is FindingKind.JUMP)
    assert found.part == jump().bones[figure().of(Part.UPPER_ARM)[0]].name
    assert found.remedy is not None
    assert frames <= found.remedy.trim_end <= frames + 1
