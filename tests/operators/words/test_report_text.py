"""The report's words for differences."""

from __future__ import annotations

import pytest
from hangtime.operators.words.report_text import gravity_lines, higher


@pytest.mark.parametrize(
    ("centimetres", "said"),
    [
        (1.34, "1.3 cm higher"),
        (-1.34, "1.3 cm lower"),
        (0.04, "as high as recorded"),
        (-0.0, "as high as recorded"),
    ],
)
def test_a_difference_of_heights_is_said_where_there_is_one(centimetres: float, said: str) -> None:
    assert higher(centimetres) == said


def test_body_weights_are_told_to_be_the_earths_where_gravity_is_another() -> None:
    assert gravity_lines(9.81) == []
    assert gravity_lines(1.62) == ["1.62 m/s²; body weights (BW) are those on Earth all the same"]
