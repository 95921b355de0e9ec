"""The campaign's own doings: what counts as how a case ended, and that a case can be done again."""

import tempfile
from collections.abc import Callable
from pathlib import Path

import pytest

pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.devtools.campaign.families.all_families import FAMILIES, family_of
from hangtime.devtools.campaign.protocol.case import (
    CaseOutcome,
    Changed,
    Ending,
    Family,
    HostileCase,
    LeftBehind,
    run_case,
)
from hangtime.devtools.campaign.table import table
from hangtime.solver.data.faults import NoArmature


def refused(_: HostileCase) -> None:
    raise NoArmature("clip.fbx")


def changed(_: HostileCase) -> None:
    raise Changed("the recording")


def left_behind(_: HostileCase) -> None:
    raise LeftBehind("a process")


def untidy(_: HostileCase) -> None:
    tempfile.mkstemp()


@pytest.mark.parametrize(
    ("run", "ending"),
    [
        (lambda _: None, Ending.SUCCESS),
        (refused, Ending.NAMED_FAULT),
        (changed, Ending.CHANGED),
        (left_behind, Ending.LEFTOVER),
        (untidy, Ending.LEFTOVER),
    ],
)
def test_how_a_case_ended(
    run: Callable[[HostileCase], None],
    ending: Ending,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", None)  # and back, whatever a case sets
    folder = tmp_path / "7"
    assert run_case(Family("one", 1.0, 1.0, run), 7, 0, folder).ending is ending
    assert folder.exists() != ending.good  # what ended badly can be looked at


def test_a_case_is_the_same_every_time(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tempfile, "tempdir", None)
    drawn = []
    family = Family("one", 1.0, 1.0, lambda case: drawn.append(case.rng.random()))
    for number in (3, 3, 4):
        run_case(family, number, 0, tmp_path / "case")
    assert drawn[0] == drawn[1] != drawn[2]
    assert {family_of(n, 0).name for n in range(5000)} == {each.name for each in FAMILIES}


def test_the_table_adds_up() -> None:
    families = [Family(name, 1.0, 1.0, refused) for name in ("one", "other")]
    outcomes = [
        CaseOutcome(0, "one", Ending.SUCCESS, taken_on=True),
        CaseOutcome(1, "other", Ending.CRASH),
    ]
    rows = table(outcomes, families, 5).splitlines()[-3:]
    assert [row.split(" | ")[1:5] for row in rows] == [
        ["1", "1", "1", "0"],
        ["1", "0", "0", "0"],
        ["2", "1", "1", "0"],
    ]
