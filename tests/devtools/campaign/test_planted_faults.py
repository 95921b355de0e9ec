"""A fault that is planted in the product is reported by the campaign, and without it nothing is."""

from dataclasses import replace
from itertools import count, islice
from pathlib import Path

import pytest

pytest.importorskip("bpy", reason="needs the bpy module")

from hangtime.devtools.campaign import runner
from hangtime.devtools.campaign.families.all_families import family_of
from hangtime.devtools.campaign.protocol.case import Ending, Family

SEED = 3
SHORT = 5.0  # s; the bound of a case that is to hang
PLANTED = "tests.devtools.campaign.planted_fault"

pytestmark = pytest.mark.slow


def cases_of(family: str, number: int) -> list[int]:
    return list(islice((n for n in count() if family_of(n, SEED).name == family), number))


@pytest.mark.parametrize(
    ("fault", "family", "number", "ending"),
    [
        ("raw_traceback", "BVH files", 10, Ending.CRASH),
        ("pose_of_nan", "BVH files", 10, Ending.CRASH),
        ("lost_key", "recipes, mixed", 10, Ending.CRASH),
        ("scratch_left", "recipes, mixed", 2, Ending.LEFTOVER),
        ("half_an_output", "output folders", 20, Ending.LEFTOVER),
        ("key_changed", "sessions, quick", 5, Ending.CHANGED),
        ("cost_of_nan", "requests", 4, Ending.CRASH),
        ("silent_worker", "worker killed", 1, Ending.HANG),
        ("busy_for_ever", "BVH files", 1, Ending.HANG),
    ],
)
def test_a_planted_fault_is_reported(
    fault: str,
    family: str,
    number: int,
    ending: Ending,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def soon(number: int, seed: int) -> Family:
        usual = family_of(number, seed)
        return replace(usual, bound=SHORT) if ending is Ending.HANG else usual

    monkeypatch.setattr(runner, "family_of", soon)
    if ending is Ending.HANG:
        monkeypatch.setattr(runner, "START", 2.0 * SHORT)
    numbers = cases_of(family, number)
    told = runner.run_cases(numbers, SEED, tmp_path, 1, lambda _: None, (PLANTED, fault))
    assert ending in {outcome.ending for outcome in told}


@pytest.mark.parametrize(
    ("family", "number"),
    [
        ("BVH files", 10),
        ("recipes, mixed", 10),
        ("output folders", 20),
        ("sessions, quick", 5),
        ("requests", 4),
    ],
)
def test_without_a_fault_none_is_reported(family: str, number: int, tmp_path: Path) -> None:
    numbers = cases_of(family, number)
    told = runner.run_cases(numbers, SEED, tmp_path, 1, lambda _: None)
    assert all(outcome.ending.good for outcome in told)
