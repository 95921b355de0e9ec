"""Shares, slopes and verdicts of pairs whose changes are known."""

import json
from dataclasses import replace

import pytest
from hangtime.devtools.pairs.compare import FailedPair
from hangtime.devtools.pairs.limits import MEASURES, WithDistance, figures, slope, with_distance
from hangtime.devtools.pairs.moved import MovedLanding
from hangtime.devtools.pairs.results import Results
from hangtime.devtools.pairs.table import page, solution_rows, text
from hangtime.tests.devtools.pairs.made_up import pair


@pytest.mark.parametrize("measure", MEASURES)
def test_share_is_one_where_all_of_the_change_is_found_and_zero_where_none_is(measure: str) -> None:
    assert pair(0.2, person=3.0, ours=3.0).share(measure) == pytest.approx(1.0)
    assert pair(0.2, person=3.0, ours=0.0).share(measure) == 0.0
    assert pair(0.2, person=3.0, ours=-3.0).share(measure) == pytest.approx(-1.0)


def test_a_person_who_changed_nothing_leaves_no_share() -> None:
    assert pair(0.2, person=0.0, ours=3.0).share("crouch_cm") is None


def test_slope_weighs_large_changes_and_keeps_the_sign() -> None:
    half = [pair(0.2, person=x, ours=0.5 * x) for x in (-4.0, 1.0, 2.0)]
    assert slope(half, "crouch_cm") == pytest.approx(0.5)
    assert slope([], "crouch_cm") is None


def test_a_change_in_proportion_to_the_distance_is_explained_by_it() -> None:
    pairs = [pair(x, person=7.0 * x, ours=2.0 * x) for x in (-0.2, 0.1, 0.3)]
    told = with_distance(pairs, "crouch_cm")
    assert told is not None
    assert (told.person, told.ours, told.share) == pytest.approx((7.0, 2.0, 1.0))
    same = [pair(x, person=1.0, ours=0.0) for x in (-0.2, 0.2)]
    assert with_distance(same, "crouch_cm") == WithDistance(0.0, 0.0, 0.0)
    assert with_distance([], "crouch_cm") is None


def test_figures_tell_far_pairs_and_null_pairs_apart() -> None:
    pairs = [
        pair(0.20, person=2.0, ours=2.0),
        pair(-0.15, person=-2.0, ours=0.0),
        pair(0.01, person=1.0, ours=0.7),
        pair(0.0, person=0.0, ours=0.2, target="source"),
    ]
    found = {figure.name: figure for figure in figures(pairs, "implicit")}
    assert found["crouch: slope"].value == pytest.approx(4.7 / 9.0)
    assert found["crouch: slope, 10 cm or more"].value == pytest.approx(0.5)
    longer = found["crouch: slope, longer by 10 cm or more"]
    assert (longer.value, longer.count, longer.ok) == (pytest.approx(1.0), 1, True)
    assert found["joint centres, flight: mean gain"].value == pytest.approx(50.0)
    assert found["joint centres, landing: nearer than slid"].value == 0.0
    assert found["null pairs, own landing: crouch, worst"].value == pytest.approx(0.2)
    near = found["null pairs, landing within 2 cm: crouch, worst"]
    assert near.value == pytest.approx(0.7)
    assert not near.ok


def test_results_are_told_in_json_in_lines_and_on_a_page(tmp_path) -> None:
    failed = FailedPair("source", "far away", "implicit", "no way")
    moved = pair(0.2, person=2.0, ours=0.0)
    landing = MovedLanding("source", "implicit", 0.1, "stalled", moved.before, moved.after)
    results = Results.of(("implicit",), [moved, failed], {"source": 0.9}, [landing])
    results.write(tmp_path / "figures.json")
    found = json.loads((tmp_path / "figures.json").read_text(encoding="utf-8"))
    assert found["pairs"][0]["shares"]["crouch_cm"] == 0.0
    assert found["moved landings"][0]["forward"] == 0.1
    assert found["failed"][0]["why"] == "no way"
    assert "Infinity" not in (tmp_path / "figures.json").read_text(encoding="utf-8")
    assert any(figure.name == "crouch: slope" for figure in results.missed())
    for told in (text(results), page(results)):
        assert "source → target" in told
        assert "MISSED" in told
        assert "no way" in told
        assert "implicit (stalled)" in told
        assert "4.0 / 4.0 / 4.0" in told


def test_solutions_are_told_by_their_difference_to_the_first() -> None:
    first = [pair(0.2, person=2.0, ours=1.0), pair(-0.2, person=2.0, ours=0.0, target="back")]
    second = [
        replace(pair(0.2, person=2.0, ours=4.0), solution="power", seconds=3.0),
        replace(pair(-0.2, person=2.0, ours=1.0, target="back"), solution="power", seconds=5.0),
    ]
    results = Results.of(("implicit", "power"), [*first, *second], {}, [])
    head, implicit, power = solution_rows(results)
    column = head.index("flight time (ms)")
    assert (implicit[column], power[column]) == ("+0", "+2")
    assert power[-1] == "4.0"
    assert "power" in page(results)
