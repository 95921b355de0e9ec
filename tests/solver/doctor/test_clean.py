"""A clean recording has no findings, whatever its frame rate."""

from dataclasses import replace

import pytest
from hangtime.solver.doctor.examination.diagnose import diagnose
from hangtime.solver.doctor.finding import FindingKind
from hangtime.tests.helpers.clips import JUMP, load_recording
from hangtime.tests.helpers.doctored import jump, sparse

WHOLE, CUT_AT = (150.0, 336.0), 200.0  # frames; in the flight that a jump cuts in two
CLIPS = "131_03_hop.bvh", JUMP, "hop_01_01.bvh", "fair1_jumping.bvh"


def test_a_clean_recording_has_no_findings() -> None:
    assert diagnose(jump(), mass=70.0).findings == ()


def test_frames_that_are_kept_begin_in_the_air_where_the_clip_does() -> None:
    """Not where two takes were joined there, of which one is kept."""
    recording = load_recording(JUMP).window(*WHOLE)
    aloft = diagnose(recording.window(CUT_AT, WHOLE[1])).findings
    assert [finding.kind for finding in aloft] == [FindingKind.BEGINS_IN_AIR]
    heads = recording.heads.copy()
    heads[recording.frames < CUT_AT, :, 0] += 1.0
    joined = diagnose(replace(recording, heads=heads))
    assert joined.kept[0] == CUT_AT
    assert [finding.kind for finding in joined.findings] == [FindingKind.JUMP]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "every", "first"),
    [
        ("131_03_hop.bvh", 6, 5),  # whose wrist turns by 82° in 1/30 s
        *((name, every, 0) for name in CLIPS for every in (8, 10)),
        ("rokoko_jesse_dance.bvh", 5, 0),  # who treads fast
        ("run_1.bvh", 2, 1),  # whose toes strike
        ("run_3.bvh", 10, 0),  # of whose feet four frames slide alike
    ],
)
def test_a_clean_recording_of_few_frames_has_no_findings(name, every, first) -> None:
    """Steps from frame to frame are long, and unlike each other, at 12 to 60 Hz."""
    clip = sparse(load_recording(name), every, first)
    assert [finding for finding in diagnose(clip).findings if not finding.kind.note] == []
