"""A flight that was retimed among others is told with its frames, and is carried by nothing."""

import pytest
from hangtime.devtools.doctor.damages.clock import ramped
from hangtime.operators.words.doctor_text import finding_sentence
from hangtime.solver.data.constants import STANDARD_GRAVITY
from hangtime.solver.data.recording import Recording
from hangtime.solver.doctor.examination.diagnose import diagnose
from hangtime.solver.doctor.finding import FindingKind
from hangtime.tests.helpers.clips import load_recording
from hangtime.tests.helpers.doctored import jump


def hops() -> Recording:
    """With long flights in frames 432 to 467, 511 to 544 and 585 to 628."""
    return load_recording("hops_in_place.bvh").window(400, 660)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("factor", "way"),
    [(1.5, "slowly"), (2.0, "slowly"), (1 / 1.5, "fast"), (1 / 2.1, "fast")],
)
def test_a_flight_that_falls_otherwise_than_others_is_told_with_its_frames(
    factor: float, way: str
) -> None:
    (found,) = diagnose(ramped(factor).of(hops()).recording).findings
    assert found.kind is FindingKind.RETIMED
    assert found.amount == pytest.approx(STANDARD_GRAVITY / factor**2, rel=0.1)
    ((first, last),) = found.frames
    assert last - first == pytest.approx(34 * factor, abs=10 * factor)
    told = finding_sentence(found)
    assert f"in frames {first:g} to {last:g}" in told
    assert f"times too {way}" in told
    assert "choose frames without it" in told


def test_of_clean_hops_nothing_is_told() -> None:
    assert diagnose(hops()).findings == ()


def test_one_flight_alone_tells_no_part() -> None:
    assert not ramped(1.5).possible(jump())
    assert ramped(1.5).possible(hops())
