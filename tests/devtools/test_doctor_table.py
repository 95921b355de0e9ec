"""The doctor's table: its figures, and which of them end the command with 1."""

import pytest
from hangtime.devtools.doctor.damages.every import DAMAGES
from hangtime.devtools.doctor.fits import (
    NOISE,
    WITHOUT_FLIGHT,
    FittedClip,
    fitted,
    one_of_each_kind,
    without_flight,
)
from hangtime.devtools.doctor.limits import figures, fit_figures
from hangtime.devtools.doctor.measure import Examined
from hangtime.devtools.doctor.table import fits_page, page, verdict
from hangtime.solver.data.problem import MotionProblem
from hangtime.solver.doctor.finding import FindingKind
from hangtime.solver.worker.pipeline import measure
from hangtime.tests.helpers.clips import load_recording

CLEAN = Examined("jump", "", None, True, (), None, 0.0, 0.0)
SLOW = Examined("jump", "time × 2", FindingKind.TIME_SCALE, True, (), 0.02, 0.0, 0.0)
UNSEEN = Examined("jump", "drift 0.2 m/s", FindingKind.SLIDING, False, ("floor",), None, 0.3, 0.3)


def test_a_false_alarm_is_a_miss() -> None:
    assert [f.missed for f in figures([CLEAN])] == [False]
    alarmed = Examined("jump", "", None, True, ("spike",), None, 0.0, 0.0)
    (alarm,) = figures([alarmed])
    assert alarm.missed
    assert alarm.where == "jump: spike"


def test_recall_precision_and_scale() -> None:
    found = {f.name: f for f in figures([CLEAN, SLOW, UNSEEN])}
    assert found["damages named rightly (recall)"].value == 50.0
    assert found["damages named rightly (recall)"].missed
    assert found["findings that are right (precision)"].value == 50.0
    assert found["time scale: recovered, off by (median)"].value == 2.0
    assert verdict(found["time scale: recovered, off by (median)"]) == "ok"


def test_the_page_has_a_row_for_each_damage() -> None:
    examined = [CLEAN, SLOW, UNSEEN]
    text = page(examined, figures(examined), 3.0)
    assert "| time × 2 | 1 | 1 |  | 0.0 | 0.0 | 2.0 (2.0) |" in text
    assert "| drift 0.2 m/s | 1 | 0 (not jump) | floor | 30.0 | 30.0 |  |" in text


def test_a_fit_that_does_not_end_is_a_miss_and_told() -> None:
    good = FittedClip("jump", NOISE, True, "", 0.013, 0.009, 0.0004)
    failed = FittedClip("run", "jump of 0.4 m", False, "No motion was found.")
    found = {f.name: f for f in fit_figures([good, failed])}
    assert found["fits that end with a valid motion"].value == 50.0
    assert found["fits that end with a valid motion"].missed
    assert found[f"{NOISE}: joint centres off (mean)"].value == pytest.approx(1.3)
    assert found[f"{NOISE}: sliding left"].value == pytest.approx(0.4)
    text = fits_page([good, failed], list(found.values()), 3.0)
    assert f"| {NOISE} | 1 | 1 | 0.9 (0.9) | 1.3 (1.3) | 0.40 | 0 | 0 |" in text
    assert "| jump of 0.4 m | 1 | 0 (not run) |" in text
    assert "run, jump of 0.4 m: No motion was found." in text


def test_one_damage_of_each_finding_is_fitted() -> None:
    assert {damage.kind for damage in one_of_each_kind()} == {damage.kind for damage in DAMAGES}
    assert NOISE in {damage.name for damage in one_of_each_kind()}


@pytest.mark.slow
def test_what_does_not_fly_in_a_clip_of_jumps_is_fitted() -> None:
    whole = load_recording("131_03_hop.bvh")
    part = without_flight(whole)
    assert part is not None
    assert measure(part, MotionProblem()).analysis.schedule.flights == ()
    found = fitted("131_03_hop", WITHOUT_FLIGHT, part, part)
    assert found.valid, found.said
    assert found.off_fitted < 0.025
