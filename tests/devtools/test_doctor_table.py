"""The doctor's table: its figures, and which of them end the command with 1."""

from hangtime.devtools.doctor.limits import figures
from hangtime.devtools.doctor.measure import Examined
from hangtime.devtools.doctor.table import page, verdict
from hangtime.solver.doctor.finding import FindingKind

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
