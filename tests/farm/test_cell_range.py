"""Ranges of cells, as Flamenco and OpenJD write them."""

import pytest
from hangtime.batch.farm.cell_range import numbers_of, range_text
from hangtime.batch.records.faults import WrongPlan


@pytest.mark.parametrize(
    ("text", "numbers"),
    [
        ("7", [7]),
        ("1-4", [1, 2, 3, 4]),
        ("9,10,12", [9, 10, 12]),
        (" 3 , 1 - 2", [1, 2, 3]),
        ("1-10:4,2", [1, 2, 5, 9]),
        ("12,12", [12]),
    ],
)
def test_a_range_names_cells(text: str, numbers: list[int]) -> None:
    assert numbers_of(text, 12) == numbers


@pytest.mark.parametrize(
    "text", ["", "a", "0", "13", "3-2", "1-99999999999", "1-4:0", "-3", "1,,2"]
)
def test_what_is_none_is_refused_in_words(text: str) -> None:
    with pytest.raises(WrongPlan, match=r"^“.*” is no range"):
        numbers_of(text, 12)


def test_a_range_is_written_as_it_is_read() -> None:
    assert range_text([1, 2, 3, 7, 9, 10]) == "1-3,7,9-10"
    assert numbers_of(range_text(range(1, 601)), 600) == list(range(1, 601))
